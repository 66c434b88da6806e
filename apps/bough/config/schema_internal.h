// What the files of the schema share among themselves: units and ranges.
#ifndef BOUGH_APPS_CONFIG_SCHEMA_INTERNAL_H
#define BOUGH_APPS_CONFIG_SCHEMA_INTERNAL_H

#include "apps/bough/config/schema.h"

// Whether the text is a unit of the dimension; `why` then says why not.
bool bough_unit_fits(const char *text, bough_dimension dimension, char why[160]);

// Memory for the items of a list, which is then in the key's field of the struct `item` with its count; NULL
// (and an error) when the node is not one long enough.
void *bough_schema_items(bough_schema_reader *r, const bough_key *key, const bough_node *node, size_t size,
                         void *item);

// An error: the value of a key that increases is not more than the one before it.
void bough_schema_not_more(bough_schema_reader *r, const char *key, const bough_node *before,
                           const bough_node *node);

// The first key of that name; NULL: there is none.
const bough_key *bough_schema_find(const bough_schema *schema, const char *name);

static inline void *bough_field_at(void *item, size_t offset) { return (char *)item + offset; }

#endif
