// The table of all channels: name, unit, meaning, and OpenFAST's name. The channels of a run and the
// documentation follow from it.
#pragma once

#include "apps/bough/results/channels.h"

typedef struct bough_channel_row {
    const char *name; // "{a}" and "{b}" are replaced by the first and the second part
    const char *unit;
    const char *meaning;  // axes and sign
    const char *openfast; // its name there, NULL: it has none
    int component;        // 1, 2 or 3 of a vector whose components are adjacent; 0: a scalar
    int divisor;          // a quotient: its divisor is so many channels before it; 0: it is none
} bough_channel_row;

// The channels of a part of a scene.
typedef struct bough_channel_family {
    const char *title; // the part
    const char *parts; // meaning of {a} and {b}; NULL: there are none
    int n;
    const bough_channel_row *row; // (n), in the order of the values
    bough_sampling sampled;       // of all its values
} bough_channel_family;

typedef enum bough_channel_part {
    BOUGH_CHANNELS_ROTOR,
    BOUGH_CHANNELS_REVOLUTE,
    BOUGH_CHANNELS_PRISMATIC,
    BOUGH_CHANNELS_CYLINDRICAL,
    BOUGH_CHANNELS_UNIVERSAL,
    BOUGH_CHANNELS_PLANAR,
    BOUGH_CHANNELS_FREE,
    BOUGH_CHANNELS_TURNING,
    BOUGH_CHANNELS_DRIVE_TORQUE,
    BOUGH_CHANNELS_DRIVE_FORCE,
    BOUGH_CHANNELS_DRIVE_UNIVERSAL,
    BOUGH_CHANNELS_SPRING,
    BOUGH_CHANNELS_BUSHING,
    BOUGH_CHANNELS_CLOSURE,
    BOUGH_CHANNELS_MARKER,
    BOUGH_CHANNELS_BLADE,
    BOUGH_CHANNELS_TOWER,
    BOUGH_CHANNELS_TIP,
    BOUGH_CHANNELS_FMU,
    BOUGH_CHANNELS_BLADE_SECTION,
    BOUGH_CHANNELS_TOWER_SECTION,
    BOUGH_CHANNELS_SECTION,
    BOUGH_CHANNELS_SHAFT,
    BOUGH_CHANNELS_YAW_BEARING,
    BOUGH_CHANNELS_AIR,
    BOUGH_CHANNELS_WIND,
    BOUGH_CHANNELS_ROTOR_WIND,
    BOUGH_CHANNELS_ELEMENT,
    BOUGH_CHANNELS_GENERATOR,
    BOUGH_CHANNELS_CONTROL,
    BOUGH_CHANNELS_PITCH,
    BOUGH_CHANNELS_LAW,
    BOUGH_CHANNELS_LAW_PITCH,
    BOUGH_CHANNEL_PARTS,
} bough_channel_part;

// Adds the channels of a part to the list's last group.
void bough_channel_family_add(bough_channels *list, bough_channel_part part, const char *a, const char *b);

// Adds a group with the channels of a part without names.
void bough_channel_group_add(bough_channels *list, bough_channel_sample *sample, void *self,
                             bough_channel_part part);

// Writes all of them as Markdown, after the text of channel_help.md.
extern const unsigned char bough_channel_help_text[];
void bough_channel_table_help(FILE *stream);
