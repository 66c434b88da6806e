// What the readers of a WindIO turbine share. Each reads a part of the file, in the layout of
// version 1 (outer_shape_bem, angles in radians) or 2 (outer_shape, degrees), and writes its part
// of the scene and of the list.
#ifndef BOUGH_IMPORT_WINDIO_H
#define BOUGH_IMPORT_WINDIO_H

#include "apps/bough/import/entry.h"
#include "apps/bough/import/import.h"

// An airfoil's place on the blade.
typedef struct bough_windio_place {
    const bough_node *airfoil; // its entry in the list of airfoils
    int number;                // in the scene's polars
    double share, thickness;   // of the blade's reference line; relative to the chord
} bough_windio_place;

typedef struct bough_windio_shape {
    bough_windio_place *place; // (n)
    int n;
    bool by_thickness; // elements find their airfoils by thickness, not by share
    bough_curve chord, twist, thickness;
    bough_curve pitch_axis;         // version 1: share of the chord before the line; else none
    bough_curve offset_x, offset_y; // version 2: of the chord line [m]
} bough_windio_shape;

typedef struct bough_windio {
    bough_draft draft;
    const bough_import_options *options;
    const bough_node *root, *parts; // the file; its components
    const bough_node *blade, *shape, *hub, *train;
    const bough_node *tower; // NULL: none
    bool second;             // the layout of version 2
    double degree;           // unit of its angles [deg]
    double forward;          // 1: the rotor is upwind of the tower, -1: downwind
    int n_blade;
    bough_windio_shape outline;      // of the blade
    bough_curve axis[3];             // the blade's reference line over its share [m]
    double blade_length, blade_mass; // along z [m]; [kg]
    bool shear_stiff;                // the blade's matrices have no shear
    double inertia;                  // of the rotor about its axis [kg m2]
    double hub_radius, radius;       // [m]
    double tower_base, tower_top;    // above ground [m]
    double hub_height;               // above the tower's top [m]
    double density;                  // of the air [kg/m3]
    double rated_power;              // of the generator [W]
    double rated_speed;              // of the rotor [rad/s]
    double speed, wind;              // at the start: rotor [rad/s], air [m/s]
} bough_windio;

// A number of the control block, by a name of version 1 or of version 2, of which both stand in either. Its
// unit is that of the file's version: `second_unit` is what one of version 2 is in version 1. The fallback is
// in version 1's unit.
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

// The place of the airfoil at a share of the blade or before it: *share of the next one.
int bough_windio_neighbours(const bough_windio_shape *shape, double at, double *share);

// The reference line's distance from the leading edge, along the chord [m].
double bough_windio_line(const bough_windio_shape *shape, double at);

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

#endif
