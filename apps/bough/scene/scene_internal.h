// What the files that read a scene share among themselves.
#pragma once

#include "apps/bough/config/schema.h"
#include "apps/bough/config/schema_keys.h"
#include "apps/bough/scene/scene.h"

// The table of a whole scene; fills a bough_scene.
extern const bough_schema bough_scene_schema;

// Those of its parts.
extern const bough_schema bough_scene_micro_schema, bough_scene_body_schema, bough_scene_load_schema,
    bough_scene_spring_schema, bough_scene_bushing_schema, bough_scene_closure_schema,
    bough_scene_marker_schema, bough_scene_sensor_schema, bough_scene_turbine_schema,
    bough_scene_block_schema, bough_scene_aero_schema, bough_scene_control_schema;

// The page about scenes before its list of keys, scene_help.md with a line "@UNITS@" where the list of units
// goes.
extern const unsigned char bough_scene_help_text[];

// Readers of values that are lists of their own kind. `field` is named in the body.
void bough_scene_read_placement(bough_schema_reader *r, const bough_node *node, void *field);
void bough_scene_read_stiffness(bough_schema_reader *r, const bough_node *node, void *field);
void bough_scene_read_section_mass(bough_schema_reader *r, const bough_node *node, void *field);
void bough_scene_read_motion(bough_schema_reader *r, const bough_node *node, void *field);
void bough_scene_read_inertia(bough_schema_reader *r, const bough_node *node, void *field);

// Adds an error at each of the keys "a|b" that the mapping has.
void bough_scene_refuse(bough_schema_reader *r, const bough_node *mapping, const char *keys,
                        const char *format, ...) __attribute__((format(printf, 4, 5)));

// Values over time.
typedef struct bough_scene_table {
    const bough_node *node;
    int n_time, n_value;    // equal
    double *times, *values; // (n_time) strictly increasing [s]; SI
} bough_scene_table;

// Reads {times: [...], values: [...]} with values of that dimension; false after an error.
bool bough_scene_read_table(bough_schema_reader *r, const bough_node *node, bough_dimension unit,
                            bough_scene_table *table);

// Checks within one mapping or file; `item` is the struct that was read.
void bough_scene_check_structure(bough_schema_reader *r, void *item);
void bough_scene_check_rod(bough_schema_reader *r, void *item);
void bough_scene_check_body(bough_schema_reader *r, void *item);

void bough_scene_check_aero_blade(bough_schema_reader *r, void *item);
void bough_scene_check_polar(bough_schema_reader *r, void *item);
void bough_scene_check_polars(bough_schema_reader *r, void *item);
void bough_scene_check_wind_table(bough_schema_reader *r, void *item);
void bough_scene_check_wind(bough_schema_reader *r, void *item);
void bough_scene_check_tower(bough_schema_reader *r, void *item);
void bough_scene_check_joint(bough_schema_reader *r, void *item);
void bough_scene_check_fmu(bough_schema_reader *r, void *item);
void bough_scene_check_control_fmu(bough_schema_reader *r, void *item);
void bough_scene_read_values(bough_schema_reader *r, const bough_node *node, void *field);
void bough_scene_check_motion(bough_schema_reader *r, const bough_scene_joint *joint);
void bough_scene_check_ramp(bough_schema_reader *r, const bough_node *node, const double ramp[2]);

// Checks a load against the body, load->body, that it acts on.
void bough_scene_check_body_load(bough_schema_reader *r, const bough_scene *scene,
                                 const bough_scene_load *load);

// The tree of a scene in which a turbine in one block (`blades` is a number) is replaced by its bodies;
// `root` where there is none. NULL after an error in the block.
bough_node *bough_scene_expand(bough_schema_reader *reader, bough_node *root);

// Sets the keys that the scene does not name to the values that follow from simulation.accuracy, by the laws
// in scene_accuracy.c.
void bough_scene_apply_accuracy(bough_scene *scene);

// Whether time/step is a whole number, at least one; also true after an error in either.
bool bough_scene_is_multiple(double time, double step);

// Resolves names and checks what spans several parts of the scene.
void bough_scene_link(bough_schema_reader *r, bough_scene *scene);

enum { BOUGH_UNRESOLVED = -2 }; // the index of a name that no body has

// Sets the path of the next errors.
void bough_link_at(bough_schema_reader *r, const char *format, ...) __attribute__((format(printf, 2, 3)));

// The index of the body that a key of `node` names; BOUGH_UNRESOLVED after an error.
int bough_link_body(bough_schema_reader *r, const bough_scene *s, const bough_node *node, const char *key,
                    const char *name);

// Parts of bough_scene_link, in this order.
void bough_link_fmus(bough_schema_reader *r, bough_scene *s);
void bough_link_turbine(bough_schema_reader *r, bough_scene *s);
void bough_link_aero(bough_schema_reader *r, bough_scene *s);
void bough_link_control(bough_schema_reader *r, bough_scene *s);
void bough_link_inputs(bough_schema_reader *r, bough_scene *s);

// Replaces or adds the value that "path.to[2].key=value" names; the new root, or NULL after an
// error. Nodes that an alias shares are copied before they change.
bough_node *bough_scene_set(bough_arena *arena, bough_node *root, const char *set, bough_errors *errors);

// -- an FMU ---------------------------------------------------------------------------------------

// The keys of every FMU, in a struct FILLS that has it as `model`.
#define BOUGH_FMU_KEYS(file, values)                                                                         \
    {NAMED("folder", TEXT), AT(model.folder), .required = true, .example = file,                             \
     .help = "FMU of FMI 3.0 for co-simulation, its archive or the folder where it is unpacked, relative "   \
             "to the scene"},                                                                                \
    {                                                                                                        \
        NAMED("parameters", CUSTOM), AT(model.parameters),                                                   \
            .read = bough_scene_read_values, .form = "{NAME: NUMBER, ...}", .example = values,               \
            .help =                                                                                          \
                "values of its parameters, each in the unit that the FMU declares; the others keep theirs"   \
    }

// -- an FMU as an archive (fmu_archive.c): ZIP (PKWARE's APPNOTE 6.3) of at most 4 GB ----------------

// Whether the name is that of an archive: it ends with ".fmu".
bool bough_fmu_is_archive(const char *path);

// Unpacks all files into a new folder below $TMPDIR, else /tmp, which is removed with the arena.
// BOUGH_INVALID: there is no such archive, it is damaged, encrypted or of ZIP64, or a file's name leads out
// of the folder. BOUGH_IO: the folder cannot be written.
bough_status bough_fmu_archive_unpack(bough_arena *arena, const char *path, const char **folder);

// -- modelDescription.xml of an FMU of FMI 3.0 (fmu_description.c) --------------------------------

// Reads modelDescription.xml in the folder of an FMU, which is called `fmu` in messages. BOUGH_INVALID: the
// file is missing or is no XML, the version is not 3, there is no co-simulation.
bough_status bough_fmu_describe(bough_arena *arena, const char *fmu, const char *folder,
                                bough_fmu_description *description);

// The variable of that name; NULL: there is none.
const bough_fmu_variable *bough_fmu_find(const bough_fmu_description *d, const char *name);

// Whether a variable's unit is declared with a factor other than 1 or with an offset.
bool bough_fmu_scaled(const bough_fmu_description *d, const bough_fmu_variable *variable);

// -- words of the tables of keys ------------------------------------------------------------------

// clang-format off
#define ZERO3 "[0, 0, 0]"
#define AXIS CHOICES([BOUGH_SCENE_X] = "x", [BOUGH_SCENE_Y] = "y", [BOUGH_SCENE_Z] = "z")
#define WIND_SPEED_RANGE "[0, 150]"
#define PLACEMENT_FORM "list of 'move x|y|z LENGTH' and 'rotate x|y|z ANGLE'"

#define RAMP                                                                                       \
    {KEY(VECTOR, ramp), .count = 2, UNIT(TIME), .range = ">= 0", .fallback = "[0, 0]",             \
     .example = "[0 s, 20 s]",                                                                     \
     .help = "grows linearly from zero at the first time to the full value at the second; two "    \
             "equal times above 0 make a jump"}
