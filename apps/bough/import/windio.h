// What the readers of a WindIO turbine share. Each reads a part of the file, in the layout of
// version 1 (outer_shape_bem, angles in radians) or 2 (outer_shape, degrees), and writes its part
// of the scene and of the list.
#pragma once

#include "apps/bough/config/base.h"
#include "apps/bough/import/draft.h"
#include "apps/bough/import/import.h"

// -- entries of a WindIO file (entry.c) -----------------------------------------------------------

// Values of a YAML file by the path of their keys, "blade.outer_shape|outer_shape_bem.chord": words
// between points, each a key or several spellings of it.
//
// The first failure is kept in the draft's status, with file:line:col, path and what was expected;
// afterwards all reads return 0 or nothing, so that a reader may check once at its end.

// The tree of a file; NULL after a failure.
const bough_node *bough_entry_read(bough_draft *d, const char *path);

// The value at the path below `from` (NULL allowed); NULL: none.
const bough_node *bough_entry(const bough_node *from, const char *path);

// The same; a failure where there is none.
const bough_node *bough_entry_need(bough_draft *d, const bough_node *from, const char *path);

// A number, a text; with a fallback where there is none.
double bough_entry_number(bough_draft *d, const bough_node *from, const char *path);
double bough_entry_number_or(bough_draft *d, const bough_node *from, const char *path, double fallback);
const char *bough_entry_text(bough_draft *d, const bough_node *from, const char *path);

// The numbers of a list; *n: how many it must have, 0: any number, which is then returned.
const double *bough_entry_numbers(bough_draft *d, const bough_node *from, const char *path, int *n);

// The item of a list of mappings that has this name; NULL: none.
const bough_node *bough_entry_named(const bough_node *list, const char *name);

// A quantity over a coordinate that never falls: {grid: [...], values: [...]}.
typedef struct bough_curve {
    const bough_node *node;
    int n;
    const double *x, *y; // (n)
} bough_curve;

bough_curve bough_entry_curve(bough_draft *d, const bough_node *from, const char *path);

// A curve of these numbers (n each), which must outlive it; `node` says where they stand.
bough_curve bough_curve_of(bough_draft *d, const bough_node *node, const double *x, const double *y, int n);

// Linear between the points, constant outside; 0 of a curve that could not be read.
double bough_curve_at(const bough_curve *c, double x);

// The coordinates of all curves' points in increasing order, without those closer than `least` to the one
// before; returns their number.
int bough_curve_places(bough_draft *d, const bough_curve *const *curve, int n_curve, double least,
                       double **place);

// The same of curves over a fraction of the span, with 0 and 1.
int bough_curve_fractions(bough_draft *d, const bough_curve *const *curve, int n_curve, double least,
                          double **fraction);

// Keeps a failure at a node, unless there was one.
void bough_entry_fail(bough_draft *d, const bough_node *where, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

// -- the turbine ------------------------------------------------------------------------------------

// An airfoil's place on the blade.
typedef struct bough_windio_place {
    const bough_node *airfoil;  // its entry in the list of airfoils
    int number;                 // in the scene's polars
    double fraction, thickness; // of the blade's reference line; relative to the chord
} bough_windio_place;

typedef struct bough_windio_shape {
    bough_windio_place *place; // (n)
    int n;
    bool by_thickness; // elements find their airfoils by thickness, not by position
    bough_curve chord, twist, thickness;
    bough_curve pitch_axis;         // version 1: fraction of the chord before the line; else none
    bough_curve offset_x, offset_y; // version 2: of the chord line [m]
} bough_windio_shape;

typedef struct bough_windio {
    bough_draft *draft;
    const bough_node *root, *parts; // the file; its components
    const bough_node *blade, *shape, *hub, *train;
    const bough_node *tower; // NULL: none
    bool second;             // the layout of version 2
    double degree;           // unit of its angles [deg]
    double forward;          // 1: the rotor is upwind of the tower, -1: downwind
    int n_blade;
    bough_windio_shape outline;      // of the blade
    bough_curve axis[3];             // the blade's reference line over the fraction of its length [m]
    double blade_length, blade_mass; // along z [m]; [kg]
    bool shear_stiff;                // the blade's matrices have no shear
    double inertia;                  // of the rotor about its axis [kg m2]
    double hub_radius, radius;       // [m]
    double tower_base, tower_top;    // above ground [m]
    bough_curve height, diameter;    // of the tower, over the fraction of its length [m]
    double hub_height;               // above the tower's top [m]
    double density;                  // of the air [kg/m3]
    double rated_power;              // of the generator [W]
    double rated_speed;              // of the rotor [rad/s]
    double speed, wind;              // at the start: rotor [rad/s], air [m/s]
} bough_windio;

// A number of the control block, by its name in version 1 or in version 2: files of either have both. Its
// unit is that of the file's version: `second_unit` is one unit of version 2 in those of version 1. The
// fallback is in version 1's unit.
double bough_windio_control(bough_windio *w, const char *first, const char *second, double second_unit,
                            double fallback);

// The material that a layer names; NULL after a failure. The k-th value of a material's property, of which it
// may have one for all directions.
const bough_node *bough_windio_material(bough_windio *w, const bough_node *layer);
double bough_windio_property(bough_windio *w, const bough_node *material, const char *key, int k);

// Fails at the first angle above 90 deg: files with degrees where their version has radians.
void bough_windio_check_angles(bough_windio *w, const bough_curve *angles, const char *name);

// The blade's shape, into `outline`.
void bough_windio_shape_read(bough_windio *w);

// The index of the airfoil at a fraction of the blade or before it; *weight: that of the next one [-].
int bough_windio_neighbours(const bough_windio_shape *shape, double at, double *weight);

// The reference line's distance from the leading edge, along the chord [m].
double bough_windio_line(const bough_windio_shape *shape, double at);

// Times of damping of the six strains [s], structural_damping.mu of `from` (NULL allowed), or where that has
// none six times `usual`, with a note about the part.
const double *bough_windio_damping(bough_windio *w, const bough_node *from, const char *part, double usual);

// Table of the blade's structure.
void bough_windio_blade(bough_windio *w);

// Tables of airfoils and blade elements.
void bough_windio_air_tables(bough_windio *w);

// Table of the tower's structure, and the part aero.tower.
void bough_windio_tower(bough_windio *w);
void bough_windio_tower_air(bough_windio *w);

// The parts `bodies` and `turbine`, `aero` and `control` of the scene.
void bough_windio_bodies(bough_windio *w);
void bough_windio_air(bough_windio *w);
void bough_windio_law(bough_windio *w);

// -- stiffness and inertia from layers and webs on the outlines (windio_layup.c) ------------------

// 6 × 6 matrices about the reference line in section axes, of which the upper triangle is given.
typedef struct bough_windio_matrices {
    const bough_node *node;
    int n;
    const double *grid; // (n) fractions of the blade
    double *entry;      // (21 × n), the values of one entry side by side
} bough_windio_matrices;

// Whether the blade has layers.
bool bough_windio_has_layers(const bough_windio *w);

void bough_windio_layup(bough_windio *w, bough_windio_matrices *stiffness, bough_windio_matrices *mass);
