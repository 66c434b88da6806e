// Loads of a scene: on a joint's axis, on a rod at a place or along a stretch, on a rigid body.
#include "apps/bough/scene/scene_internal.h"

#include <string.h>

// -- reading --------------------------------------------------------------------------------------

// field: the load
void bough_scene_read_load_place(bough_schema_reader *r, const bough_node *node, void *field) {
    bough_scene_load *load = field;
    const char *text = node->kind == BOUGH_SCALAR ? node->text : "";
    char why[160] = "";
    double plain;
    load->place = BOUGH_SCENE_AT_TIP;
    if (strcmp(text, "tip") == 0) return;
    load->place = BOUGH_SCENE_AT_VERTEX;
    if (bough_whole_number(text, &load->vertex)) return;
    load->place = BOUGH_SCENE_AT_SPAN;
    bool unit = !bough_quantity(text, BOUGH_PURE_NUMBER, &plain, why);
    if (unit && bough_quantity(text, BOUGH_LENGTH, &load->span[0], why)) return;
    bough_schema_expected(r, node, "'tip', the number of a vertex or a length with its unit, as '30 m'");
}

static bool is_spread(const bough_scene_load *load) { return bough_node_find(load->node, "along") != NULL; }

// Three numbers, with or without a unit.
static void read_three(bough_schema_reader *r, const bough_node *node, bough_dimension dimension,
                       double *values) {
    const bough_key key = {.kind = BOUGH_KEY_VECTOR, .count = 3, .dimension = dimension};
    bough_schema_value(r, &key, node, values);
}

// field: the load; a table over time in the key's dimension
void bough_scene_read_load_table(bough_schema_reader *r, const bough_node *node, void *field) {
    bough_scene_load *load = field;
    bough_scene_table table;
    if (!bough_scene_read_table(r, node, r->key->dimension, &table)) return;
    load->n_time = table.n_time;
    load->times = table.times;
    load->values = table.values;
}

// field: the load; a number or a table over time in the key's dimension
void bough_scene_read_load_amount(bough_schema_reader *r, const bough_node *node, void *field) {
    bough_scene_load *load = field;
    if (node->kind == BOUGH_MAPPING) {
        bough_scene_read_load_table(r, node, load);
    } else {
        load->amount = bough_schema_number(r, node, r->key->dimension);
    }
}

void bough_scene_read_load_force(bough_schema_reader *r, const bough_node *node, void *field) {
    bough_scene_load *load = field;
    if (bough_node_find(load->node, "body") == NULL) {
        bough_scene_read_load_amount(r, node, load);
    } else {
        read_three(r, node, is_spread(load) ? BOUGH_LINE_FORCE : BOUGH_FORCE, load->force);
    }
}

void bough_scene_read_load_moment(bough_schema_reader *r, const bough_node *node, void *field) {
    bough_scene_load *load = field;
    read_three(r, node, is_spread(load) ? BOUGH_LINE_MOMENT : BOUGH_MOMENT, load->moment);
}

// -- checks within a load -------------------------------------------------------------------------

// Exactly one of two keys must be given.
static bool check_either(bough_schema_reader *r, const bough_node *load, const char *a, const char *b) {
    const bough_node *first = bough_node_find(load, a), *second = bough_node_find(load, b);
    if ((first == NULL) != (second == NULL)) return true;
    bough_schema_error(r, load, "", "expected either '%s' or '%s'%s", a, b,
                       first == NULL ? "" : ", got both");
    return false;
}

static void check_joint_keys(bough_schema_reader *r, const bough_node *load) {
    check_either(r, load, "torque", "force");
    bough_scene_refuse(r, load, "at|along|moment|frame|factor|point|end_force|end_moment",
                       "only used with 'body'");
}

// Where an end is not given it is as the start.
static void read_ends(bough_schema_reader *r, bough_scene_load *load) {
    if (!is_spread(load)) bough_scene_refuse(r, load->node, "end_force|end_moment", "only used with 'along'");
    if (bough_node_find(load->node, "end_force") == NULL) {
        memcpy(load->end_force, load->force, sizeof load->force);
    }
    if (bough_node_find(load->node, "end_moment") == NULL) {
        memcpy(load->end_moment, load->moment, sizeof load->moment);
    }
}

static void check_body_keys(bough_schema_reader *r, bough_scene_load *load) {
    bough_scene_refuse(r, load->node, "torque", "only used with 'joint'");
    if (bough_node_find(load->node, "at") != NULL && !check_either(r, load->node, "at", "along")) {
        return;
    }
    if (load->n_time > 0) bough_scene_refuse(r, load->node, "ramp", "only used without 'factor'");
    if (bough_node_find(load->node, "force") == NULL && bough_node_find(load->node, "moment") == NULL &&
        bough_node_find(load->node, "end_force") == NULL &&
        bough_node_find(load->node, "end_moment") == NULL) {
        bough_schema_error(r, load->node, "", "expected a 'force' or a 'moment' or both");
    }
    read_ends(r, load);
    if (!is_spread(load)) return;
    load->place = BOUGH_SCENE_ALONG;
    if (load->span[1] > load->span[0]) return;
    bough_schema_error(r, load->node, "along", "must end after it starts, got [%g m, %g m]", load->span[0],
                       load->span[1]);
}

void bough_scene_check_load(bough_schema_reader *r, void *item) {
    bough_scene_load *load = item;
    if (!check_either(r, load->node, "joint", "body")) return;
    if (load->body_name == NULL) {
        check_joint_keys(r, load->node);
    } else {
        check_body_keys(r, load);
    }
    bough_scene_check_ramp(r, load->node, load->ramp);
    if (load->input == NULL || (load->n_time == 0 && load->ramp[1] == 0)) return;
    bough_schema_error(r, load->node, "input", "only without a ramp or a table");
}

// -- checks against the body ----------------------------------------------------------------------

double bough_scene_arc_length(const bough_scene_structure *s) {
    double sum = 0;
    if (s->n_station == 1) return s->length;
    for (int k = 1; k < s->n_station; k++) {
        sum += bough_norm(bough_sub(s->station[k].def.position, s->station[k - 1].def.position));
    }
    return sum;
}

// The place must be on the rod, up to rounding of its length.
static void check_place(bough_schema_reader *r, const bough_scene_load *load, const bough_scene_rod *rod) {
    double length = bough_scene_arc_length(&rod->structure), most = length * (1 + 1e-9);
    if (load->place == BOUGH_SCENE_AT_VERTEX && (load->vertex < 0 || load->vertex > rod->n_segment)) {
        bough_schema_error(r, load->node, "at", "'%s' has the vertices 0 to %d, got %d", load->body_name,
                           rod->n_segment, load->vertex);
    }
    if (load->place == BOUGH_SCENE_AT_SPAN && (load->span[0] > most || load->span[0] < 0)) {
        bough_schema_error(r, load->node, "at", "'%s' is %g m long, got %g m", load->body_name, length,
                           load->span[0]);
    }
    if (is_spread(load) && load->span[1] > most) {
        bough_schema_error(r, load->node, "along", "'%s' is %g m long, got %g m", load->body_name, length,
                           load->span[1]);
    }
}

static void check_rigid_load(bough_schema_reader *r, const bough_scene_load *load) {
    bough_scene_refuse(r, load->node, "at|along", "'%s' is rigid: give the 'point'", load->body_name);
    if (load->frame != BOUGH_SCENE_LOAD_FOLLOWER) return;
    bough_schema_error(r, load->node, "frame", "'%s' is rigid: 'frame: body' turns with it", load->body_name);
}

void bough_scene_check_body_load(bough_schema_reader *r, const bough_scene *scene,
                                 const bough_scene_load *load) {
    const bough_scene_body *body = &scene->body[load->body];
    if (body->fidelity == BOUGH_SCENE_RIGID) check_rigid_load(r, load);
    if (!bough_scene_is_flexible(body)) return;
    if (body->fidelity == BOUGH_SCENE_FMU) {
        bough_schema_error(r, load->node, "body", "'%s' is an FMU: loads act on rigid bodies and rods",
                           load->body_name);
        return;
    }
    bough_scene_refuse(r, load->node, "point", "only used with a rigid body");
    if (!check_either(r, load->node, "at", "along")) return;
    if (body->fidelity != BOUGH_SCENE_ROD && load->frame == BOUGH_SCENE_LOAD_FOLLOWER) {
        bough_schema_error(r, load->node, "frame",
                           "'%s' is a modal body, on which loads do not turn with its sections: make"
                           " it a rod or give 'frame: body'",
                           load->body_name);
    }
    if (body->rod.structure.n_station > 0) check_place(r, load, &body->rod);
}
