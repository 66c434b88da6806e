// The parameters of a scene for sensitivities of modes, and scenes in which one of them is changed.
#include "apps/bough/analysis/sensitivity.h"

#include "apps/bough/analysis/air_tangent.h"
#include "apps/bough/model/companion.h"
#include "core/base/linalg.h"

typedef void change_section(bough_section_station *x, double change);
typedef void change_scene(bough_scene *scene, double change);

// A kind of parameter changes each station of the rods of some bodies, their damping, or the scene.
typedef struct kind {
    const char *name, *by;
    double change;
    unsigned stiffness; // set of its components, 1 << c
    change_section *section;
    bool damping;
    change_scene *scene;
} kind;

// -- sections -------------------------------------------------------------------------------------

// Scales a stiffness and its couplings, so that the matrix stays positive definite.
static void scale_stiffness(bough_section_station *x, int component, double change) {
    for (int j = 0; j < 6; j++)
        x->stiffness[bough_symmetric6_index(component, j)] *= j == component ? 1 + change : sqrt(1 + change);
}

static void change_mass(bough_section_station *x, double change) {
    x->mass *= 1 + change;
    for (int k = 0; k < 4; k++) x->inertia[k] *= 1 + change;
}

// By Steiner's theorem along y: Ixx and Izz, and the product of inertia −∫ x y.
static void shift_mass(bough_section_station *x, double change) {
    double from = x->centre[1], to = from + change, moment = x->mass * (to * to - from * from);
    x->inertia[0] += moment;
    x->inertia[2] -= x->mass * x->centre[0] * change;
    x->inertia[3] += moment;
    x->centre[1] = to;
}

// About a shear centre shifted by y the shear strain along x (component 0) of a twist κ (component 5) is
// smaller by y κ: K ← Tᵀ K T with T = E − y e₀ e₅ᵀ.
static void shift_shear_centre(bough_section_station *x, double change) {
    double full[6][6];
    bough_symmetric6_unpack(x->stiffness, full);
    for (int i = 0; i < 6; i++) full[i][5] -= change * full[i][0];
    for (int j = 0; j < 6; j++) full[5][j] -= change * full[0][j];
    for (int i = 0; i < 6; i++)
        for (int j = i; j < 6; j++) x->stiffness[bough_symmetric6_index(i, j)] = full[i][j];
}

// -- the scene ------------------------------------------------------------------------------------

static void change_pitch(bough_scene *scene, double change) {
    for (int k = 0; k < scene->turbine.n_blade; k++) scene->body[scene->turbine.blade[k]].pitch += change;
}

static void change_speed(bough_scene *scene, double change) {
    bough_scene_joint *joint = &scene->body[scene->turbine.rotor].joint;
    joint->speeds[0] *= 1 + change;
    if (joint->motion[0].def.given && joint->motion[0].def.speed) {
        joint->motion[0].def.from *= 1 + change;
        joint->motion[0].def.to *= 1 + change;
    }
}

static void change_density(bough_scene *scene, double change) { scene->aero.air_density *= 1 + change; }
static void change_wind(bough_scene *scene, double change) { scene->aero.wind.def.speed *= 1 + change; }

enum { RODS = 9, PITCH = RODS, SPEED, DENSITY, WIND, KINDS };

static const kind kinds[KINDS] = {
    {"structural damping", "1 %", 0.01, .damping = true},
    {"bending stiffness about x", "1 %", 0.01, .stiffness = 1 << 3},
    {"bending stiffness about y", "1 %", 0.01, .stiffness = 1 << 4},
    {"torsional stiffness", "1 %", 0.01, .stiffness = 1 << 5},
    {"shear stiffness", "1 %", 0.01, .stiffness = 1 << 0 | 1 << 1},
    {"axial stiffness", "1 %", 0.01, .stiffness = 1 << 2},
    {"mass", "1 %", 0.01, .section = change_mass},
    {"mass centre along y", "1 cm", 0.01, .section = shift_mass},
    {"shear centre along y", "1 cm", 0.01, .section = shift_shear_centre},
    [PITCH] = {"pitch of the blades", "0.1 deg", 0.1 * BOUGH_DEGREE, .scene = change_pitch},
    [SPEED] = {"rotor speed", "1 %", 0.01, .scene = change_speed},
    [DENSITY] = {"air density", "1 %", 0.01, .scene = change_density},
    [WIND] = {"wind speed", "1 %", 0.01, .scene = change_wind},
};

// -- list -----------------------------------------------------------------------------------------

static void add_rods(const char *name, int n_body, int *body, bough_parameter *list, int *n) {
    for (int k = 0; k < RODS; k++) {
        bough_parameter *x = &list[(*n)++];
        *x = (bough_parameter){.kind = k, .by = kinds[k].by, .n_body = n_body, .body = body};
        snprintf(x->name, sizeof x->name, "%.40s: %s", name, kinds[k].name);
    }
}

static void add_scene(int of, bough_parameter *list, int *n) {
    list[*n] = (bough_parameter){.kind = of, .by = kinds[of].by};
    snprintf(list[(*n)++].name, sizeof list->name, "%s", kinds[of].name);
}

const bough_parameter *bough_parameters_of(bough_arena *arena, const bough_scene *scene, int *n) {
    bool air = bough_air_follows(scene);
    size_t most = (size_t)(scene->n_body + 1) * RODS + KINDS;
    bough_parameter *list = bough_arena_take(arena, most * sizeof *list);
    int *body = bough_arena_take(arena, ((size_t)scene->n_body + 1) * sizeof *body), *next = body;
    *n = 0;
    for (int k = 0; scene->turbine.node && k < scene->turbine.n_blade; k++)
        if (bough_scene_has_mesh(&scene->body[scene->turbine.blade[k]])) *next++ = scene->turbine.blade[k];
    if (next > body) add_rods("blades", (int)(next - body), body, list, n);
    for (int i = 0; i < scene->n_body; i++) {
        bool blade = scene->turbine.node && bough_scene_blade(scene, i) >= 0;
        if (blade || !bough_scene_has_mesh(&scene->body[i])) continue;
        *next = i;
        add_rods(scene->body[i].name, 1, next++, list, n);
    }
    if (scene->turbine.node) add_scene(PITCH, list, n);
    if (scene->turbine.node) add_scene(SPEED, list, n);
    if (air) add_scene(DENSITY, list, n);
    if (air && bough_scene_wind_is_steady(&scene->aero.wind)) add_scene(WIND, list, n);
    return list;
}

// -- changes --------------------------------------------------------------------------------------

static void change_rod(bough_arena *arena, const kind *of, double change, bough_scene_structure *x) {
    for (int k = 0; k < 6 && of->damping; k++) x->damping[k] *= 1 + change;
    bough_scene_station *station =
        bough_arena_copy(arena, x->station, (size_t)x->n_station * sizeof *station);
    for (int k = 0; k < x->n_station; k++) {
        for (int c = 0; c < 6; c++)
            if (of->stiffness >> c & 1) scale_stiffness(&station[k].def, c, change);
        if (of->section) of->section(&station[k].def, change);
    }
    x->station = station;
}

bough_scene *bough_parameter_change(bough_arena *arena, const bough_scene *scene, const bough_parameter *x,
                                    double times) {
    const kind *of = &kinds[x->kind];
    bough_scene *to = bough_coarser_scene(arena, scene, 0);
    for (int i = 0; i < x->n_body; i++)
        change_rod(arena, of, times * of->change, &to->body[x->body[i]].rod.structure);
    if (of->scene) of->scene(to, times * of->change);
    return to;
}
