#include "apps/bough/import/section.h"

#include "core/base/linalg.h"

static void put_stiffness(FILE *file, const double k[BOUGH_IMPORT_MATRIX]) {
    double entry[21];
    bool diagonal = true;
    int n = 0;
    for (int i = 0; i < 6; i++) {
        for (int j = i; j < 6; j++) {
            entry[n++] = (k[i * 6 + j] + k[j * 6 + i]) / 2;
            diagonal = diagonal && (i == j || entry[n - 1] == 0);
        }
    }
    const double main[] = {k[0], k[7], k[14], k[21], k[28], k[35]};
    if (diagonal)
        bough_import_list(file, main, 6);
    else
        bough_import_list(file, entry, 21);
}

static void put_mass(FILE *file, const double m[BOUGH_IMPORT_MATRIX]) {
    const double row[] = {m[0], -m[2 * 6 + 4] / m[0], m[2 * 6 + 3] / m[0], m[21], m[28], (m[22] + m[27]) / 2,
                          m[35]};
    bough_import_list(file, row, 7);
}

void bough_section_matrix_head(FILE *file) {
    fputs("stations:\n  columns: [span, twist deg, axis, stiffness, mass]\n  rows:\n", file);
}

void bough_section_matrix_put(FILE *file, const bough_section_place *at, const double k[BOUGH_IMPORT_MATRIX],
                              const double m[BOUGH_IMPORT_MATRIX]) {
    fprintf(file, "    - [%.10g, %.10g, [%.10g, %.10g], ", at->z, at->twist, at->x, at->y);
    put_stiffness(file, k);
    fputs(", ", file);
    put_mass(file, m);
    fputs("]\n", file);
}

void bough_section_note(bough_draft *d, double deviation) {
    if (!(deviation > 1e-3)) return;
    bough_draft_note(
        d, BOUGH_APPROXIMATED,
        "mass matrices: only mass, centre and inertias; other entries, up to %.2g of these, are left out",
        deviation);
}

bool bough_section_possible(const double k[BOUGH_IMPORT_MATRIX], const double m[BOUGH_IMPORT_MATRIX]) {
    double stiffness[BOUGH_IMPORT_MATRIX], mass = m[0];
    double x = -m[2 * 6 + 4] / mass, y = m[2 * 6 + 3] / mass;
    double product = (m[22] + m[27]) / 2 + mass * x * y;
    double inertia[] = {m[21] - mass * y * y,          product, 0, product, m[28] - mass * x * x, 0, 0, 0,
                        m[35] - mass * (x * x + y * y)};
    for (int i = 0; i < BOUGH_IMPORT_MATRIX; i++) stiffness[i] = (k[i] + k[i % 6 * 6 + i / 6]) / 2;
    return mass > 0 && bough_cholesky_factor(6, stiffness) && bough_cholesky_factor(3, inertia);
}

double bough_section_deviation(const double m[BOUGH_IMPORT_MATRIX]) {
    double mass = m[0], x = -m[2 * 6 + 4], y = m[2 * 6 + 3], polar = m[35];
    double off[] = {(m[7] - mass) / mass,
                    (m[14] - mass) / mass,
                    (m[5] + y) / (mass + fabs(y)),
                    (m[11] - x) / (mass + fabs(x)),
                    m[1] / mass,
                    m[2] / mass,
                    m[8] / mass,
                    m[3] / mass,
                    m[4] / mass,
                    m[9] / mass,
                    m[10] / mass,
                    m[17] / mass,
                    polar > 0 ? m[23] / polar : 0,
                    polar > 0 ? m[29] / polar : 0};
    double most = 0;
    for (size_t i = 0; i < sizeof off / sizeof *off; i++) most = fmax(most, fabs(off[i]));
    return most;
}

enum { CELLS = 200, ROUNDS = 6 };

// Stodola's iteration: the deflection under the mode's own inertial load, and Rayleigh's quotient.
double bough_section_frequency(int n, const double *span, const double *stiffness, const double *mass) {
    double h = (span[n - 1] - span[0]) / CELLS, square = 0;
    double shape[CELLS], load[CELLS], moment[CELLS];
    for (int i = 0; i < CELLS; i++) shape[i] = (i + 0.5) * (i + 0.5);
    for (int round = 0; round < ROUNDS; round++) {
        double shear = 0, bend = 0, slope = 0, place = 0, work = 0, kinetic = 0;
        for (int i = CELLS - 1; i >= 0; i--) {
            load[i] = bough_table_value(n, span, mass, span[0] + (i + 0.5) * h) * shape[i];
            moment[i] = bend + shear * h / 2 + load[i] * h * h / 8; // in the cell's middle
            bend += shear * h + load[i] * h * h / 2;
            shear += load[i] * h;
        }
        for (int i = 0; i < CELLS; i++) {
            double curvature = moment[i] / bough_table_value(n, span, stiffness, span[0] + (i + 0.5) * h);
            double middle = place + slope * h / 2 + curvature * h * h / 8;
            work += load[i] * middle;
            kinetic += load[i] / shape[i] * middle * middle;
            shape[i] = middle;
            place += slope * h + curvature * h * h / 2;
            slope += curvature * h;
        }
        square = work / kinetic;
        for (int i = 0; i < CELLS; i++) shape[i] /= place;
    }
    return sqrt(square);
}

void bough_section_head(FILE *file, double length, const double *time) {
    fprintf(file, "length: %.10g\ndamping: ", length);
    bough_import_list(file, time, 6);
    fputs("  # s\nstations:\n  columns: [span, twist deg, stiffness, mass]\n  rows:\n", file);
}

void bough_section_put(FILE *file, const bough_section *s) {
    const double stiffness[] = {s->shear, s->shear, s->axial, s->bend_x, s->bend_y, s->torsion};
    double ratio = s->mass / s->axial; // of one material: inertia over stiffness
    const double mass[] = {s->mass, 0, 0, s->bend_x * ratio, s->bend_y * ratio, 0};
    fprintf(file, "    - [%.10g, %.10g, ", s->span, s->twist);
    bough_import_list(file, stiffness, 6);
    fputs(", ", file);
    bough_import_list(file, mass, 6);
    fputs("]\n", file);
}
