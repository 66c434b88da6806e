// ElastoDyn's furling: the rotor's offset and skew, and the joints about which rotor and tail furl.
#include "apps/import/openfast.h"

#include <math.h>
#include <string.h>

static const double degree = 3.14159265358979323846 / 180;

// Three numbers of one line, or of three lines `stem`x, `stem`y, `stem`z before OpenFAST 3.
static bough_vec3 read_point(const bough_deck *f, const char *name, const char *stem) {
    double x[3];
    if (bough_deck_three(f, name, x)) return (bough_vec3){x[0], x[1], x[2]};
    for (int c = 0; c < 3; c++) {
        char key[40];
        snprintf(key, sizeof key, "%s%cn", stem, 'x' + c);
        x[c] = bough_deck_number(f, key);
    }
    return (bough_vec3){x[0], x[1], x[2]};
}

// A joint that furls: an axis through a point of the nacelle, turned about z, then up.
typedef struct furl {
    const char *name, *letter; // "tail", 'T' of its keys
    bough_vec3 point;
    double skew, tilt; // [deg]
} furl;

static double value(const bough_deck *f, const furl *a, const char *rest) {
    char key[40];
    snprintf(key, sizeof key, "%sFrl%s", a->letter, rest);
    return bough_deck_number(f, key);
}

static furl read_furl(const bough_deck *f, const char *name, const char *letter) {
    furl a = {.name = name, .letter = letter};
    char point[24], stem[24];
    snprintf(point, sizeof point, "%sFrlPnt_n", letter);
    snprintf(stem, sizeof stem, "%sFrlPnt", letter);
    a.point = read_point(f, point, stem);
    a.skew = value(f, &a, "Skew");
    a.tilt = value(f, &a, "Tilt");
    return a;
}

// A point of the nacelle in the joint's frame.
static bough_vec3 in_joint(const furl *a, bough_vec3 p) {
    bough_vec3 d = bough_sub(p, a->point);
    double c = cos(a->skew * degree), s = sin(a->skew * degree);
    bough_vec3 turned = {c * d.x + s * d.y, -s * d.x + c * d.y, d.z};
    c = cos(a->tilt * degree), s = sin(a->tilt * degree);
    return (bough_vec3){c * turned.x + s * turned.z, turned.y, -s * turned.x + c * turned.z};
}

// Body and joint; its spring, damper and stops act with the model "standard" only, its stops with the
// stiffer of both.
static void put_furl(bough_openfast *o, const furl *a, bool turns, double mass, bough_vec3 centre) {
    const bough_deck *f = o->furl;
    FILE *file = o->draft.file[BOUGH_IMPORT_SCENE];
    const char *start = a->letter[0] == 'T' ? "TailFurl" : "RotFurl";
    bough_vec3 c = in_joint(a, centre);
    double about = value(f, a, "Iner") - mass * (c.y * c.y + c.z * c.z);
    fprintf(file,
            "  - name: %s\n    fidelity: rigid\n    joint:\n      kind: %s\n      parent: nacelle\n"
            "      placement: [move x %.10g m, move y %.10g m, move z %.10g m, rotate z %.10g deg, "
            "rotate y %.10g deg%s",
            a->name, turns ? "revolute" : "fixed", a->point.x, a->point.y, a->point.z, a->skew, -a->tilt,
            turns ? "]\n      axis: x\n" : "");
    if (!turns) fprintf(file, ", rotate x %.10g deg]\n", bough_deck_number(f, start));
    if (turns) fprintf(file, "      angle: %.10g deg\n", bough_deck_number(f, start));
    if (turns && bough_deck_whole_or(f, a->letter[0] == 'T' ? "TFrlMod" : "RFrlMod", 0) == 1) {
        double down = value(f, a, "DSSP"), up = value(f, a, "USSP");
        double stiffness = fmax(value(f, a, "USSpr"), value(f, a, "DSSpr"));
        fprintf(file, "      stiffness: %.10g\n      damping: %.10g\n", value(f, a, "Spr"),
                value(f, a, "Dmp"));
        if (stiffness > 0 && up > down) {
            fprintf(file, "      stop: [%.10g deg, %.10g deg]\n      stop_stiffness: %.10g\n", down, up,
                    stiffness);
        }
    }
    fprintf(
        file,
        "    mass: %.10g kg\n    centre_of_mass: [%.10g, %.10g, %.10g]\n    inertia: [%.10g, %.10g, %.10g]\n",
        mass, c.x, c.y, c.z, fmax(about, 0), fmax(about, 0), fmax(about, 0));
    bough_draft_note(&o->draft, BOUGH_TAKEN, "%s: %g kg%s", a->name, mass,
                     turns ? ", furls about its axis with spring, damper and stops" : "");
}

void bough_openfast_furl(bough_openfast *o) {
    if (!bough_deck_flag_or(o->elasto, "Furling", false)) return;
    o->furl = bough_openfast_open(o, o->elasto, "FurlFile");
    if (!bough_is_ok(o->draft.status)) return;
    const bough_deck *f = o->furl;
    furl rotor = read_furl(f, "furl", "R"), tail = read_furl(f, "tail", "T");
    bough_vec3 boom = read_point(f, "BoomCM_n", "BoomCM"), fin = read_point(f, "TFinCM_n", "TFinCM");
    double light = bough_deck_number(f, "BoomMass"), end = bough_deck_number(f, "TFinMass"),
           mass = light + end;
    bough_vec3 centre =
        bough_scale(mass > 0 ? 1 / mass : 0, bough_add(bough_scale(light, boom), bough_scale(end, fin)));
    bool turns = bough_deck_flag_or(f, "RFrlDOF", false), wags = bough_deck_flag_or(f, "TFrlDOF", false);
    double carried = bough_deck_number(f, "RFrlMass");
    if (!bough_is_ok(o->draft.status)) return;
    o->rotor_furls = turns || carried > 0 || bough_deck_number(f, "RotFurl") != 0;
    if (o->rotor_furls) put_furl(o, &rotor, turns, carried, read_point(f, "RFrlCM_n", "RFrlCM"));
    if (wags || mass > 0) put_furl(o, &tail, wags, mass, mass > 0 ? centre : tail.point);
    bough_draft_note(&o->draft, BOUGH_LEFT_OUT,
                     "furling: dampers of the stops, the air's forces on the tail fin");
}

// From the body that carries the shaft to the axes of the nacelle, and the rotor's offset.
void bough_openfast_put_shaft_offset(const bough_openfast *o) {
    FILE *file = o->draft.file[BOUGH_IMPORT_SCENE];
    if (!o->furl) return;
    if (o->rotor_furls) {
        furl a = read_furl(o->furl, "furl", "R");
        fprintf(file,
                "rotate y %.10g deg, rotate z %.10g deg, move x %.10g m, move y %.10g m, move z %.10g m, ",
                a.tilt, -a.skew, -a.point.x, -a.point.y, -a.point.z);
    }
    fprintf(file, "move y %.10g m, ", bough_deck_number(o->furl, "Yaw2Shft"));
}
