// Readers of placements, matrices and tables, and checks within one mapping.
#include "apps/bough/scene/scene_internal.h"

#include "core/base/linalg.h"

// -- placement ------------------------------------------------------------------------------------

bough_mat3 bough_scene_rotation(int axis, double angle) {
    bough_vec3 turn = bough_scale(angle, bough_unit3(axis));
    return bough_rotation_matrix(bough_quaternion_exponential(turn));
}

// "move z 1.96 m" or "rotate y 5 deg"; the identity after an error.
static bough_transform read_step(bough_schema_reader *r, const bough_node *node) {
    char word[8], axis[4], shown[64], why[160] = "";
    int used = 0;
    double amount;
    bough_transform step = bough_transform_identity();
    const char *text = node->kind == BOUGH_SCALAR ? node->text : "";
    if (sscanf(text, "%7s %3s %n", word, axis, &used) == 2 && used > 0) {
        bool moves = strcmp(word, "move") == 0, rotates = strcmp(word, "rotate") == 0;
        bool named = axis[1] == '\0' && axis[0] >= 'x' && axis[0] <= 'z';
        bough_dimension dimension = rotates ? BOUGH_ANGLE : BOUGH_LENGTH;
        if ((moves || rotates) && named && bough_quantity(text + used, dimension, &amount, why)) {
            if (moves) step.position = bough_scale(amount, bough_unit3(axis[0] - 'x'));
            if (rotates) step.rotation = bough_scene_rotation(axis[0] - 'x', amount);
            return step;
        }
    }
    bough_schema_error(r, node, "", "expected 'move x|y|z LENGTH' or 'rotate x|y|z ANGLE', got %s%s%s",
                       bough_node_shown(node, shown), why[0] == '\0' ? "" : ": ", why);
    return step;
}

// field: bough_transform; each step is in the frame that the previous ones give
void bough_scene_read_placement(bough_schema_reader *r, const bough_node *node, void *field) {
    bough_transform *placement = field;
    *placement = bough_transform_identity();
    if (node->kind != BOUGH_SEQUENCE) bough_schema_expected(r, node, "a list of steps");
    for (int i = 0; node->kind == BOUGH_SEQUENCE && i < node->n; i++) {
        size_t length = bough_schema_push(r, "[%d]", i);
        *placement = bough_transform_compose(*placement, read_step(r, node->value[i]));
        bough_schema_pop(r, length);
    }
}

void bough_scene_check_joint(bough_schema_reader *r, void *item) {
    const bough_scene_joint *joint = item;
    bough_scene_check_motion(r, joint);
    bool stop = bough_node_find(joint->node, "stop") != NULL;
    if (stop != (bough_node_find(joint->node, "stop_stiffness") != NULL)) {
        bough_scene_refuse(r, joint->node, "stop|stop_stiffness", "'stop' and 'stop_stiffness' go together");
    } else if (stop && !(joint->spring.low < joint->spring.high)) {
        bough_schema_error(r, joint->node, "stop", "the second must be greater than the first");
    }
    if (joint->kind != BOUGH_JOINT_UNIVERSAL || joint->second_axis != joint->axis) return;
    bough_schema_error(r, joint->node, "second_axis", "must not be the first axis");
}

// -- matrices -------------------------------------------------------------------------------------

// The first row of the symmetric n×n matrix, scaled to a diagonal of 1, where Cholesky's factorisation has no
// pivot above 1e-12; n: there is none, and the matrix is positive definite.
static int row_without_pivot(const double *matrix, int n) {
    for (int i = 0; i < n; i++) {
        if (!(matrix[i * (n + 1)] > 0)) return i;
    }
    double leading[36];
    for (int size = 1; size <= n; size++) {
        for (int i = 0; i < size * size; i++) {
            int row = i / size, column = i % size;
            double scale = sqrt(matrix[row * (n + 1)] * matrix[column * (n + 1)]);
            leading[i] = matrix[row * n + column] / scale - (row == column ? 1e-12 : 0);
        }
        if (!bough_cholesky_factor(size, leading)) return size - 1;
    }
    return n;
}

// Reports the row of a matrix that is not positive definite: its diagonal, or the other entries.
static void refuse_row(bough_schema_reader *r, const bough_node *at, const char *what, const char *row,
                       double diagonal) {
    if (diagonal > 0) {
        bough_schema_error(r, at, "",
                           "%s must be positive definite: in the row of %s the entries off the diagonal "
                           "are too large",
                           what, row);
    } else {
        bough_schema_error(r, at, "", "%s must be positive definite: the diagonal has %g for %s", what,
                           diagonal, row);
    }
}

// field: the upper triangle (21)
void bough_scene_read_stiffness(bough_schema_reader *r, const bough_node *node, void *field) {
    double values[21], matrix[36] = {0}, *triangle = field;
    const char *what = "a list of 6 (diagonal) or 21 (upper triangle) numbers";
    int n = bough_schema_numbers(r, node, 6, 21, values, what);
    if (n < 0) return;
    for (int i = 0, at = 0; i < 6; i++) {
        for (int j = i; j < 6; j++, at++) {
            triangle[at] = n == 21 ? values[at] : i == j ? values[i] : 0;
            matrix[6 * i + j] = matrix[6 * j + i] = triangle[at];
        }
    }
    static const char *const strains[] = {"shear x",      "shear y",      "the axial strain",
                                          "bend about x", "bend about y", "twist"};
    int row = row_without_pivot(matrix, 6);
    if (row == 6) return;
    int entry = n == 6 ? row : 6 * row - row * (row - 1) / 2;
    size_t length = bough_schema_push(r, "[%d]", entry);
    refuse_row(r, node->value[entry], "the stiffness matrix", strains[row], matrix[7 * row]);
    bough_schema_pop(r, length);
}

// The inertia about the mass centre, parallel axes removed, must be positive definite.
static void check_section_inertia(bough_schema_reader *r, const bough_node *node,
                                  const bough_section_station *s) {
    static const char *const moments[] = {"Ixx - m cy^2", "Iyy - m cx^2", "Izz - m (cx^2 + cy^2)"};
    double x[4];
    bough_section_central(s, x);
    const double matrix[9] = {x[0], x[2], 0, x[2], x[1], 0, 0, 0, x[3]};
    int row = row_without_pivot(matrix, 3);
    if (row < 3) refuse_row(r, node, "the inertia about the mass centre", moments[row], matrix[4 * row]);
}

// field: the station
void bough_scene_read_section_mass(bough_schema_reader *r, const bough_node *node, void *field) {
    bough_section_station *s = field;
    double v[7];
    const char *what = "a list [m, cx, cy, Ixx, Iyy, Ixy] or with Izz";
    int n = bough_schema_numbers(r, node, 6, 7, v, what);
    if (n < 0) return;
    s->mass = v[0];
    memcpy(s->centre, v + 1, sizeof s->centre);
    memcpy(s->inertia, v + 3, 3 * sizeof *v);
    s->inertia[3] = n == 7 ? v[6] : v[3] + v[4];
    if (!(s->mass > 0)) {
        bough_schema_error(r, node->value[0], "", "the mass per length must be > 0 kg/m");
    } else {
        check_section_inertia(r, node, s);
    }
}

// The first negative principal minor of the symmetric matrix xx yy zz xy xz yz; NULL: there is none.
static const char *negative_part(const double v[6]) {
    static const char *const parts[] = {
        "Ixx", "Iyy", "Izz", "Ixx Iyy - Ixy^2", "Ixx Izz - Ixz^2", "Iyy Izz - Iyz^2", "the determinant"};
    double a = v[0], b = v[1], c = v[2], d = v[3], e = v[4], f = v[5];
    double t = 1e-12 * (fabs(a) + fabs(b) + fabs(c));
    double determinant = a * (b * c - f * f) - d * (d * c - f * e) + e * (d * f - b * e);
    const double value[] = {a, b, c, a * b - d * d, a * c - e * e, b * c - f * f, determinant};
    const double least[] = {0, 0, 0, -t * t, -t * t, -t * t, -t * t * t};
    for (int i = 0; i < 7; i++) {
        if (!(value[i] >= least[i])) return parts[i];
    }
    return NULL;
}

bool bough_scene_semidefinite(const double v[6]) { return negative_part(v) == NULL; }

static const double most_inertia = 1e18; // [kg m²]

// field: the six entries, all 0 for a point mass
void bough_scene_read_inertia(bough_schema_reader *r, const bough_node *node, void *field) {
    double v[6] = {0}, *inertia = field;
    const char *what = "a list [Ixx, Iyy, Izz] or with Ixy, Ixz, Iyz";
    if (bough_schema_numbers(r, node, 3, 6, v, what) < 0) return;
    memcpy(inertia, v, sizeof v);
    if (fmax(fmax(v[0], v[1]), v[2]) > most_inertia) {
        bough_schema_error(r, node, "", "must be at most %g kg m^2", most_inertia);
    } else if (!bough_scene_semidefinite(v)) {
        bough_schema_error(r, node, "", "the inertia matrix must not be negative about any axis, but %s is",
                           negative_part(v));
    }
}

// -- tables ---------------------------------------------------------------------------------------

// Appends "list[i]" or "list.rows[i]" to the path.
static size_t push_row(bough_schema_reader *r, const bough_node *owner, const char *list, int i) {
    const bough_node *node = bough_node_find(owner, list);
    bool compact = node != NULL && node->kind == BOUGH_MAPPING;
    return bough_schema_push(r, "%s%s%s[%d]", r->path[0] == '\0' ? "" : ".", list, compact ? ".rows" : "", i);
}

// What the first or last value of a column must be.
typedef struct column_end {
    const char *list, *key, *which, *unit_name; // "stations", "span", "first", "m"
    double expected, unit;
} column_end;

// Whether it is, to 1e-6 of its unit; false after an error.
static bool check_end(bough_schema_reader *r, const column_end *c, const bough_node *owner,
                      const bough_node *row, int i, double value) {
    if (fabs(value - c->expected) <= 1e-6 * c->unit) return true;
    size_t length = push_row(r, owner, c->list, i);
    bough_schema_error(r, row, c->key, "the %s must be %g %s, got %g %s", c->which, c->expected / c->unit,
                       c->unit_name, value / c->unit, c->unit_name);
    bough_schema_pop(r, length);
    return false;
}

static const column_end first_span = {"stations", "span", "first", "m", 0, 1};

// The last span must be the length; a single station holds for the whole length.
static void check_length(bough_schema_reader *r, bough_scene_structure *s) {
    double last = s->station[s->n_station - 1].def.position.z;
    bool given = bough_node_find(s->node, "length") != NULL;
    if (!given && s->n_station == 1) {
        bough_schema_error(r, s->node, "", "required key 'length' is missing (with one station)");
    } else if (!given) {
        s->length = last;
    } else if (s->n_station > 1 && fabs(last - s->length) > 1e-6 * s->length) {
        bough_schema_error(r, s->node, "length", "is %g m, but the last station stands at %g m", s->length,
                           last);
    }
}

void bough_scene_check_structure(bough_schema_reader *r, void *item) {
    bough_scene_structure *s = item;
    const bough_scene_station *first = &s->station[0];
    if (check_end(r, &first_span, s->node, first->node, 0, first->def.position.z)) check_length(r, s);
}

void bough_scene_check_aero_blade(bough_schema_reader *r, void *item) {
    const bough_scene_aero_blade *b = item;
    check_end(r, &first_span, b->node, b->station[0].node, 0, b->station[0].def.span);
}

// The coefficients must be the same at 180° and −180°.
static void check_turn(bough_schema_reader *r, const bough_scene_polar *p) {
    const bough_scene_polar_row *a = &p->row[0], *b = &p->row[p->n_row - 1];
    const double first[3] = {a->cl, a->cd, a->cm}, last[3] = {b->cl, b->cd, b->cm};
    static const char *const names[3] = {"cl", "cd", "cm"};
    for (int c = 0; c < 3; c++) {
        if (!(fabs(first[c] - last[c]) > 1e-6)) continue;
        size_t length = push_row(r, p->node, "table", p->n_row - 1);
        bough_schema_error(r, b->node, names[c], "at 180 deg must be as at -180 deg, %g, got %g", first[c],
                           last[c]);
        bough_schema_pop(r, length);
    }
}

void bough_scene_check_polar(bough_schema_reader *r, void *item) {
    static const column_end first = {"table", "alpha", "first", "deg", -BOUGH_PI, BOUGH_DEGREE},
                            last = {"table", "alpha", "last", "deg", BOUGH_PI, BOUGH_DEGREE};
    const bough_scene_polar *p = item;
    int n = p->n_row - 1;
    const bough_scene_polar_row *x = p->row;
    if (check_end(r, &first, p->node, x[0].node, 0, x[0].alpha) &&
        check_end(r, &last, p->node, x[n].node, n, x[n].alpha))
        check_turn(r, p);
}

void bough_scene_check_polars(bough_schema_reader *r, void *item) {
    const bough_scene_polars *p = item;
    for (int i = 0; i < p->n_polar; i++) {
        for (int k = 0; k < i; k++) {
            if (strcmp(p->polar[i].name, p->polar[k].name) != 0) continue;
            size_t length = push_row(r, p->node, "polars", i);
            bough_schema_error(r, p->polar[i].node, "name", "polar '%s' is given twice", p->polar[i].name);
            bough_schema_pop(r, length);
            break;
        }
    }
}

void bough_scene_check_wind_table(bough_schema_reader *r, void *item) {
    const bough_scene_wind_table *t = item;
    if (t->n_time != t->n_speed) {
        bough_schema_error(r, t->node, "speeds", "has %d values, but times has %d", t->n_speed, t->n_time);
    }
}

// A file has the whole wind; its path becomes relative to where the program runs.
static void check_wind_file(bough_schema_reader *r, bough_scene_wind *w) {
    bough_scene_refuse(r, w->node, "speed|table|vertical", "only used without a file");
    if (w->def.file != NULL) w->def.file = bough_schema_path(r, w->node, "file", w->def.file);
}

// A condition of the standard gives the speed over time, the extreme wind also the mean speed.
static void check_wind_condition(bough_schema_reader *r, bough_scene_wind *w) {
    bool extreme = bough_wind_iec_is_extreme_speed(w->def.iec.condition);
    if (extreme) {
        bough_scene_refuse(r, w->node, "table|vertical|speed", "not used with 'condition: ewm'");
    } else {
        bough_scene_refuse(r, w->node, "table|vertical", "not used with 'kind: iec'");
    }
    if (!extreme && !(w->def.speed > 0)) {
        bough_schema_error(r, w->node, "speed", "a speed above 0 is required with this condition");
    }
    if (extreme && !bough_node_find(w->node, "exponent")) w->def.exponent = 0.11;
    const bough_wind_iec_def *iec = &w->def.iec;
    if (!(iec->period > 0 && iec->time_step > 0)) return; // auto, or an error
    double period = bough_turbulence_period(iec->period, iec->time_step);
    if (fabs(period - iec->period) <= 1e-6 * period) return;
    bough_schema_error(r, w->node, "period",
                       "the turbulence repeats after an even number of time steps without factors other "
                       "than 2, 3 and 5: give %.9g s, got %.9g s",
                       period, iec->period);
}

void bough_scene_check_wind(bough_schema_reader *r, void *item) {
    bough_scene_wind *w = item;
    if (w->kind == BOUGH_SCENE_WIND_IEC) {
        check_wind_condition(r, w);
        return;
    }
    if (w->kind == BOUGH_SCENE_WIND_WND || w->kind == BOUGH_SCENE_WIND_BTS) {
        check_wind_file(r, w);
        return;
    }
    if (w->table.node != NULL) {
        bough_scene_refuse(r, w->node, "speed", "only used without a table");
    } else if (bough_node_find(w->node, "speed") == NULL) {
        bough_schema_error(r, w->node, "", "required key 'speed' is missing (without a table)");
    }
    if (w->kind == BOUGH_SCENE_WIND_LOG && w->def.roughness >= w->def.reference_height) {
        bough_schema_error(r, w->node, "reference_height", "must be more than the roughness, %g m, got %g m",
                           w->def.roughness, w->def.reference_height);
    }
}

void bough_scene_check_tower(bough_schema_reader *r, void *item) {
    bough_scene_tower *t = item;
    int n = t->def.n;
    if (n != t->n_diameter) {
        bough_schema_error(r, t->node, "diameter", "has %d values, but height has %d", t->n_diameter, n);
    }
    if (t->n_drag != 1 && t->n_drag != n) {
        bough_schema_error(r, t->node, "drag", "has %d values, but height has %d; give one or as many",
                           t->n_drag, n);
    }
    double *drag = bough_arena_doubles(r->arena, (size_t)n);
    for (int i = 0; i < n; i++) drag[i] = t->def.drag[t->n_drag == n ? i : 0];
    t->def.drag = drag;
}

// -- a rod that is a part of its table ------------------------------------------------------------

// Its table begins and ends between the stations of the given one.

static bough_section_station section_at(const bough_scene_structure *s, double span) {
    int k = 0;
    while (k < s->n_station - 2 && span > s->station[k + 1].def.position.z) k++;
    const bough_section_station *a = &s->station[k].def, *b = &s->station[k + 1].def;
    return bough_section_between(a, b, (span - a->position.z) / (b->position.z - a->position.z));
}

// Stations from one span to another, positions from the first.
static void cut(bough_scene_structure *s, const double part[2], bough_scene_station *to) {
    int n = 0;
    to[n++].def = section_at(s, part[0]);
    for (int k = 0; k < s->n_station; k++) {
        double span = s->station[k].def.position.z;
        if (span > part[0] && span < part[1]) to[n++] = s->station[k];
    }
    to[n++].def = section_at(s, part[1]);
    bough_vec3 origin = to[0].def.position;
    for (int k = 0; k < n; k++) to[k].def.position = bough_sub(to[k].def.position, origin);
    s->n_station = n;
    s->station = to;
}

static void take_part(bough_schema_reader *r, bough_scene_rod *rod) {
    const double *part = rod->part;
    bough_scene_structure *s = &rod->structure;
    bool good = part[0] >= 0 && part[0] < part[1] && part[1] <= s->length * (1 + 1e-9);
    if (s->n_station < 1 || !isfinite(s->length)) return; // reported already
    if (!good) {
        bough_schema_error(r, rod->node, "part",
                           "must be an interval of the table, which is %g m long, got [%g m, %g m]",
                           s->length, part[0], part[1]);
        return;
    }
    s->length = part[1] - part[0];
    if (s->n_station == 1) return; // uniform
    bough_scene_station *to = bough_arena_take(r->arena, ((size_t)s->n_station + 2) * sizeof *to);
    cut(s, part, to);
}

// -- rods and ramps -------------------------------------------------------------------------------

// A rod has a table or a uniform section, never both.
void bough_scene_check_rod(bough_schema_reader *r, void *item) {
    bough_scene_rod *rod = item;
    if (bough_node_find(rod->node, "table") != NULL) {
        bough_scene_refuse(r, rod->node, "length|stiffness|mass|twist", "only used without a table");
        if (bough_node_find(rod->node, "part") != NULL) take_part(r, rod);
        return;
    }
    bough_scene_refuse(r, rod->node, "part", "only used with a table");
    rod->uniform.node = rod->structure.node = rod->node;
    rod->structure.n_station = 1;
    rod->structure.station = bough_arena_copy(r->arena, &rod->uniform, sizeof rod->uniform);
}

// A rod without a table needs length, stiffness and mass.
static void check_section_given(bough_schema_reader *r, const bough_node *rod) {
    static const char *const needed[] = {"length", "stiffness", "mass"};
    char missing[48] = "";
    int n = 0;
    if (bough_node_find(rod, "table") != NULL) return;
    for (int i = 0; i < 3; i++) {
        if (bough_node_find(rod, needed[i]) != NULL) continue;
        size_t used = strlen(missing);
        snprintf(missing + used, sizeof missing - used, "%s'%s'", n++ == 0 ? "" : ", ", needed[i]);
    }
    if (n == 0) return;
    bough_schema_error(r, rod, "rod", "required key%s %s %s missing (without a table)", n == 1 ? "" : "s",
                       missing, n == 1 ? "is" : "are");
}

static void check_modal(bough_schema_reader *r, const bough_scene_body *b, bool has_rod) {
    bool pieces = bough_node_find(b->modal.node, "pieces") != NULL;
    if (b->fidelity == BOUGH_SCENE_MODAL && pieces) {
        bough_schema_error(r, b->node, "modal.pieces", "only used with 'fidelity: segmented-modal'");
    }
    bool named = has_rod && b->rod.n_segment > 0; // otherwise they follow from the accuracy
    if (b->fidelity == BOUGH_SCENE_SEGMENTED_MODAL && named && b->modal.pieces > b->rod.n_segment) {
        bough_schema_error(r, b->node, "modal.pieces", "%d pieces of %d segments: give the rod more segments",
                           b->modal.pieces, b->rod.n_segment);
    }
}

// Whether a rigid body with a rod has keys of mass, too.
static bool has_two_masses(const bough_scene_body *b) {
    return b->fidelity == BOUGH_SCENE_RIGID &&
           (bough_node_find(b->node, "mass") != NULL || bough_node_find(b->node, "centre_of_mass") != NULL ||
            bough_node_find(b->node, "inertia") != NULL);
}

void bough_scene_check_body(bough_schema_reader *r, void *item) {
    static const char *const flexible[] = {"", "rod", "modal", "segmented-modal"};
    const bough_scene_body *b = item;
    const bough_node *rod = bough_node_find(b->node, "rod");
    if (rod == NULL) bough_scene_refuse(r, b->node, "pitch", "only used with a rod");
    if (b->fidelity == BOUGH_SCENE_FMU) {
        bough_scene_refuse(r, b->node, "rod", "not used with 'fidelity: fmu'");
    } else if (rod != NULL && has_two_masses(b)) {
        bough_schema_error(r, b->node, "rod",
                           "a rigid body gets its mass from a rod or from 'mass', 'centre_of_mass' and "
                           "'inertia', not from both");
    } else if (rod != NULL) {
        check_section_given(r, rod);
        check_modal(r, b, true);
    } else if (b->fidelity != BOUGH_SCENE_RIGID) {
        bough_schema_error(r, b->node, "", "required key 'rod' is missing (with 'fidelity: %s')",
                           flexible[b->fidelity]);
        check_modal(r, b, false);
    }
}

void bough_scene_check_ramp(bough_schema_reader *r, const bough_node *node, const double ramp[2]) {
    if (ramp[1] < ramp[0]) {
        bough_schema_error(r, node, "ramp", "must end after it starts, got [%g s, %g s]", ramp[0], ramp[1]);
    }
}
