#include "apps/bough/import/section.h"

#include "core/base/linalg.h"

// A wall as a line in the middle of its shear stiffness.
typedef struct line {
    double length, normal[2]; // [m]; to the left of its direction
    double axial, shear;      // per length: A11 − A12²/A22, A66 [N/m]
    double thickness, middle; // [m]; depth of its middle from the nodes' line [m]
} line;

// -- laminates ------------------------------------------------------------------------------------

// Plane-stress stiffness of a ply in the axes of the span: Q11, Q12, Q22, Q66 [Pa].
typedef struct plane {
    double q11, q12, q22, q66;
} plane;

static plane plane_of(const bough_ply *p) {
    double minor = p->poisson * p->young[1] / p->young[0];
    double d = 1 - p->poisson * minor;
    double a = p->young[0] / d, b = p->young[1] / d, c = minor * p->young[0] / d, g = p->shear;
    double cosine = cos(p->angle), sine = sin(p->angle);
    double cc = cosine * cosine, ss = sine * sine, both = cc * ss;
    return (plane){a * cc * cc + 2 * (c + 2 * g) * both + b * ss * ss,
                   (a + b - 4 * g) * both + c * (cc * cc + ss * ss),
                   a * ss * ss + 2 * (c + 2 * g) * both + b * cc * cc,
                   (a + b - 2 * c - 2 * g) * both + g * (cc * cc + ss * ss)};
}

// A12/A22: without hoop force the hoop strain is −A12/A22 times the axial strain.
static double hoop_ratio(const bough_wall *w) {
    double a12 = 0, a22 = 0;
    for (int k = 0; k < w->n_ply; k++) {
        plane q = plane_of(&w->ply[k]);
        a12 += q.q12 * w->ply[k].thickness;
        a22 += q.q22 * w->ply[k].thickness;
    }
    return a12 / a22;
}

static line line_of(const bough_wall *w, const double *x, const double *y) {
    double dx = x[w->to] - x[w->from], dy = y[w->to] - y[w->from], ratio = hoop_ratio(w);
    line l = {.length = hypot(dx, dy)};
    l.normal[0] = -dy / l.length;
    l.normal[1] = dx / l.length;
    for (int k = 0; k < w->n_ply; k++) {
        plane q = plane_of(&w->ply[k]);
        double t = w->ply[k].thickness;
        l.axial += (q.q11 - q.q12 * ratio) * t;
        l.shear += q.q66 * t;
        l.middle += q.q66 * t * (l.thickness + t / 2);
        l.thickness += t;
    }
    l.middle = l.middle / l.shear - (w->centred ? l.thickness / 2 : 0);
    return l;
}

// -- tension, bending, mass -----------------------------------------------------------------------

// Adds f times the products of (1, y, −x) along a straight line of that length about its middle.
static void add_moments(double f, const double middle[2], const double way[2], double to[6]) {
    double x = middle[0], y = middle[1];
    to[0] += f;
    to[1] += f * y;
    to[2] -= f * x;
    to[3] += f * (y * y + way[1] * way[1] / 12);
    to[4] += f * (x * x + way[0] * way[0] / 12);
    to[5] -= f * (x * y + way[0] * way[1] / 12);
}

// Normals at the nodes (n × 2): the mean of their walls', or zero where these form a corner.
static void find_normals(int n_node, int n_wall, const bough_wall *wall, const line *l, double *normal) {
    memset(normal, 0, 2 * (size_t)n_node * sizeof *normal);
    for (int w = 0; w < n_wall; w++) {
        for (int e = 0; e < 2 && !wall[w].centred; e++) {
            double *to = normal + 2 * (e ? wall[w].to : wall[w].from);
            to[0] += l[w].normal[0] / 2;
            to[1] += l[w].normal[1] / 2;
        }
    }
    for (int i = 0; i < n_node; i++) {
        double *to = normal + 2 * i, size = hypot(to[0], to[1]);
        for (int c = 0; c < 2; c++) to[c] = size > 0.85 && size < 1.1 ? to[c] / size : 0;
    }
}

// The length of a curved wall at a depth.
static double length_at(const bough_wall *w, const line *l, const double *normal, double depth) {
    const double *a = normal + 2 * w->from, *b = normal + 2 * w->to;
    bool corner = hypot(a[0], a[1]) == 0 || hypot(b[0], b[1]) == 0;
    if (corner || w->centred) return l->length;
    double along = (b[0] - a[0]) * l->normal[1] - (b[1] - a[1]) * l->normal[0];
    return fmax(l->length + depth * along, 0.1 * l->length);
}

// Adds the plies of a wall, each at its depth, to stiffness and mass, each ∫ (1, y, −x, y², x², −x y).
static void add_wall(const bough_wall *w, const line *l, const double *x, const double *y,
                     const double *normal, double stiffness[6], double mass[6]) {
    double depth = w->centred ? -l->thickness / 2 : 0, ratio = hoop_ratio(w);
    double way[] = {x[w->to] - x[w->from], y[w->to] - y[w->from]};
    for (int k = 0; k < w->n_ply; k++) {
        const bough_ply *p = &w->ply[k];
        plane q = plane_of(p);
        double at = depth + p->thickness / 2, area = p->thickness * length_at(w, l, normal, at);
        double middle[] = {(x[w->from] + x[w->to]) / 2 + at * l->normal[0],
                           (y[w->from] + y[w->to]) / 2 + at * l->normal[1]};
        add_moments((q.q11 - q.q12 * ratio) * area, middle, way, stiffness);
        add_moments(p->density * area, middle, way, mass);
        depth += p->thickness;
    }
}

// -- shear flow -----------------------------------------------------------------------------------

typedef struct network {
    int n_node, n_wall;
    double *x, *y;    // (n_node) of the walls' middles
    double *area;     // (n_node) axial stiffness [N]
    double *matrix;   // ((n_node)²): warping of nodes 1 and on, twist rate last
    double *load[3];  // (n_node) for unit Vx, Vy, T; then the solutions
    double *right[3]; // (n_node) a copy of the loads
} network;

static void take(bough_arena *arena, network *n) {
    size_t m = (size_t)n->n_node;
    bough_arena_each(arena, m, &n->x, &n->y, &n->area);
    n->matrix = bough_arena_doubles(arena, m * m);
    for (int k = 0; k < 3; k++) bough_arena_each(arena, m, &n->load[k], &n->right[k]);
}

// Moves the nodes to the middles of their walls, the means of which are weighted by length.
static void place_nodes(network *n, const double *x, const double *y, const bough_wall *wall, const line *l) {
    double *weight = n->right[0];
    for (int w = 0; w < n->n_wall; w++) {
        for (int e = 0; e < 2; e++) {
            int i = e ? wall[w].to : wall[w].from;
            n->x[i] += l[w].length * l[w].middle * l[w].normal[0];
            n->y[i] += l[w].length * l[w].middle * l[w].normal[1];
            weight[i] += l[w].length;
        }
    }
    for (int i = 0; i < n->n_node; i++) {
        n->x[i] = x[i] + (weight[i] > 0 ? n->x[i] / weight[i] : 0);
        n->y[i] = y[i] + (weight[i] > 0 ? n->y[i] / weight[i] : 0);
        weight[i] = 0;
    }
}

// The last unknown is the twist rate; node 0 does not warp.
static int place_of(const network *n, int node) { return node > 0 ? node - 1 : n->n_node; }

static void assemble(network *n, const bough_wall *wall, const line *l) {
    int m = n->n_node, twist = m - 1;
    for (int w = 0; w < n->n_wall; w++) {
        int from = wall[w].from, to = wall[w].to;
        double dx = n->x[to] - n->x[from], dy = n->y[to] - n->y[from];
        double h = n->x[from] * dy - n->y[from] * dx, length = hypot(dx, dy);
        double g = l[w].shear / length;
        n->area[from] += l[w].axial * length / 2;
        n->area[to] += l[w].axial * length / 2;
        // the wall's own torsion, which is all that an open section has
        n->matrix[twist * m + twist] += l[w].shear * l[w].thickness * l[w].thickness * length / 3;
        const int place[] = {place_of(n, from), place_of(n, to), twist};
        const double weight[] = {-1, 1, h};
        for (int a = 0; a < 3; a++) {
            for (int b = 0; b < 3; b++) {
                if (place[a] < m && place[b] < m) {
                    n->matrix[place[a] * m + place[b]] += g * weight[a] * weight[b];
                }
            }
        }
    }
}

// Axial forces that increase along the span as the moments of a unit shear force do: E A (a + b x + c y).
static bool load_nodes(network *n) {
    int m = n->n_node;
    double plane_of_strain[9] = {0};
    for (int i = 0; i < m; i++) {
        const double row[] = {1, n->x[i], n->y[i]};
        for (int a = 0; a < 9; a++) plane_of_strain[a] += n->area[i] * row[a / 3] * row[a % 3];
    }
    if (!bough_cholesky_factor(3, plane_of_strain)) return false;
    for (int k = 0; k < 2; k++) {
        double c[3] = {0, k == 0, k == 1};
        bough_cholesky_solve(3, plane_of_strain, c);
        for (int i = 1; i < m; i++) n->load[k][i - 1] = n->area[i] * (c[0] + c[1] * n->x[i] + c[2] * n->y[i]);
    }
    n->load[2][m - 1] = 1;
    return true;
}

// The compliance of shear x, shear y and twist: the work of each unit load on the warping of each.
static bool solve(network *n, double compliance[9]) {
    int m = n->n_node;
    if (!load_nodes(n)) return false;
    for (int k = 0; k < 3; k++) memcpy(n->right[k], n->load[k], (size_t)m * sizeof(double));
    if (!bough_cholesky_factor(m, n->matrix)) return false;
    for (int k = 0; k < 3; k++) bough_cholesky_solve(m, n->matrix, n->load[k]);
    for (int a = 0; a < 3; a++) {
        for (int b = 0; b < 3; b++) {
            compliance[3 * a + b] = 0;
            for (int i = 0; i < m; i++) compliance[3 * a + b] += n->right[a][i] * n->load[b][i];
        }
    }
    return true;
}

// Puts the inverse of the compliance into the rows and columns of shear and twist.
static bool put_shear(double compliance[9], double stiffness[36]) {
    static const int place[] = {0, 1, 5};
    if (!bough_cholesky_factor(3, compliance)) return false;
    for (int a = 0; a < 3; a++) {
        double column[3] = {a == 0, a == 1, a == 2};
        bough_cholesky_solve(3, compliance, column);
        for (int b = 0; b < 3; b++) stiffness[6 * place[b] + place[a]] = column[b];
    }
    return true;
}

// -- the section ----------------------------------------------------------------------------------

static void put_bending(const double s[6], double to[36]) {
    static const int place[6][2] = {{2, 2}, {2, 3}, {2, 4}, {3, 3}, {4, 4}, {3, 4}};
    for (int e = 0; e < 6; e++) to[6 * place[e][0] + place[e][1]] = to[6 * place[e][1] + place[e][0]] = s[e];
}

static void put_mass(const double s[6], double to[36]) {
    put_bending(s, to);
    to[0] = to[7] = s[0];
    to[5] = to[30] = -s[1];
    to[11] = to[31] = -s[2];
    to[35] = s[3] + s[4];
}

bough_status bough_wall_section(bough_arena *arena, int n_node, const double *x, const double *y, int n_wall,
                                const bough_wall *wall, double stiffness[36], double mass[36]) {
    network n = {.n_node = n_node, .n_wall = n_wall};
    line *l = bough_arena_take(arena, (size_t)n_wall * sizeof *l);
    double *normal = bough_arena_doubles(arena, 2 * (size_t)n_node);
    take(arena, &n);
    double axial[6] = {0}, inertia[6] = {0}, compliance[9];
    // laminates
    for (int w = 0; w < n_wall; w++) {
        l[w] = line_of(&wall[w], x, y);
        bool sound = l[w].length > 0 && l[w].thickness > 0 && l[w].axial > 0 && l[w].shear > 0;
        if (!sound) return bough_fail(BOUGH_INVALID, "a wall without length, thickness or stiffness");
    }
    // tension, bending, mass
    find_normals(n_node, n_wall, wall, l, normal);
    for (int w = 0; w < n_wall; w++) add_wall(&wall[w], &l[w], x, y, normal, axial, inertia);
    memset(stiffness, 0, 36 * sizeof(double));
    memset(mass, 0, 36 * sizeof(double));
    // shear flow
    place_nodes(&n, x, y, wall, l);
    assemble(&n, wall, l);
    if (!solve(&n, compliance) || !put_shear(compliance, stiffness)) {
        return bough_fail(BOUGH_INVALID, "walls that make no section");
    }
    put_bending(axial, stiffness);
    put_mass(inertia, mass);
    return bough_ok();
}
