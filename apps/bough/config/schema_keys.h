// Words for tables of keys. A table defines FILLS before its rows, the struct whose members they fill.
#pragma once

#include "apps/bough/config/schema.h"

#define AT(member) .offset = offsetof(FILLS, member)
#define COUNT_AT(member) .count_offset = offsetof(FILLS, member)

// A key of the kind BOUGH_KEY_`of`: named as the member that it fills, or otherwise.
#define KEY(of, member) .name = #member, .kind = BOUGH_KEY_##of, AT(member)
#define NAMED(text, of) .name = text, .kind = BOUGH_KEY_##of

#define UNIT(quantity) .dimension = BOUGH_##quantity
// Words at the places of their values: [BOUGH_SCENE_X] = "x", ...
#define CHOICES(...)                                                                                         \
    .choices = (const char *const[]) { __VA_ARGS__, NULL }
#define WHEN(key, values) .when_key = key, .when = values

#define COUNT(table) (int)(sizeof(table) / sizeof(table)[0])
// The keys of a schema, rows such as {KEY(NUMBER, scale), .range = "> 0", .help = "..."}.
#define KEYS(...)                                                                                            \
    .size = sizeof(FILLS), .n_key = COUNT(((const bough_key[]){__VA_ARGS__})), .key = (const bough_key[]) {  \
        __VA_ARGS__                                                                                          \
    }
