#include "apps/bough/results/channels.h"

#include <fnmatch.h>

bough_channels bough_channels_start(bough_arena *arena) {
    const double **known = bough_arena_take(arena, sizeof *known);
    return (bough_channels){.arena = arena, .known = known, .status = bough_ok()};
}

void bough_channels_group(bough_channels *list, bough_channel_sample *sample, void *self) {
    list->group = bough_arena_grow(list->arena, list->group, list->group_count, &list->group_capacity,
                                   sizeof *list->group);
    list->group[list->group_count++] =
        (bough_channel_group){.sample = sample, .self = self, .first = list->count};
}

// The slot of the channel of that name, an empty one without such a channel.
static int *slot_of(const bough_channels *list, const char *name) {
    uint32_t hash = 2166136261u, mask = 2 * (uint32_t)list->capacity - 1;
    for (const char *c = name; *c; c++) hash = (hash ^ (unsigned char)*c) * 16777619u;
    int *slot = &list->slot[hash & mask];
    while (*slot && strcmp(list->channel[*slot - 1].name, name) != 0) {
        slot = &list->slot[++hash & mask];
    }
    return slot;
}

static void make_room(bough_channels *list) {
    int capacity = list->capacity;
    list->channel =
        bough_arena_grow(list->arena, list->channel, list->count, &list->capacity, sizeof *list->channel);
    if (capacity == list->capacity) return;
    list->slot = bough_arena_take(list->arena, 2 * (size_t)list->capacity * sizeof *list->slot);
    for (int i = 0; i < list->count; i++) *slot_of(list, list->channel[i].name) = i + 1;
}

// Units of channels that are compared: other ones have no kind.
static const struct {
    const char *unit;
    bough_quantity_kind kind;
    double si, turn;
    bool load;
} units[] = {
    {"m", BOUGH_KIND_LENGTH, 1, 0, false},
    {"deg", BOUGH_KIND_ANGLE, BOUGH_DEGREE, 360, false},
    {"rad", BOUGH_KIND_ANGLE, 1, 2 * BOUGH_PI, false},
    {"-", BOUGH_KIND_ANGLE, 1, 0, false},
    {"m/s", BOUGH_KIND_VELOCITY, 1, 0, false},
    {"deg/s", BOUGH_KIND_ANGULAR_VELOCITY, BOUGH_DEGREE, 0, false},
    {"rad/s", BOUGH_KIND_ANGULAR_VELOCITY, 1, 0, false},
    {"rpm", BOUGH_KIND_ANGULAR_VELOCITY, BOUGH_RPM, 0, false},
    {"N", BOUGH_KIND_FORCE, 1, 0, true},
    {"kN", BOUGH_KIND_FORCE, 1e3, 0, true},
    {"N-m", BOUGH_KIND_MOMENT, 1, 0, true},
    {"kN-m", BOUGH_KIND_MOMENT, 1e3, 0, true},
    {"N/m", BOUGH_KIND_OTHER, 1, 0, true},
};

static void set_unit(bough_channel *channel, const char *unit) {
    memcpy(channel->unit, unit, strlen(unit) + 1);
    channel->kind = BOUGH_KIND_OTHER;
    channel->si = 1;
    for (size_t k = 0; k < sizeof units / sizeof *units; k++) {
        if (strcmp(units[k].unit, unit) != 0) continue;
        channel->kind = units[k].kind;
        channel->si = units[k].si;
        channel->turn = units[k].turn;
        channel->load = units[k].load;
    }
}

static bool is_word(const char *text, size_t size) {
    size_t length = strlen(text);
    return length > 0 && length < size && !strpbrk(text, " \t\r\n");
}

void bough_channels_add(bough_channels *list, const char *unit, const char *format, ...) {
    assert(list->group_count > 0);
    if (!bough_is_ok(&list->status)) return;
    char name[2 * BOUGH_CHANNEL_NAME];
    BOUGH_PRINT(name, format);
    if (!is_word(name, BOUGH_CHANNEL_NAME) || strcmp(name, "Time") == 0) {
        list->status = bough_fail(
            BOUGH_INVALID,
            "'%s' cannot name an output channel: use 1 to %d characters without blanks, other than 'Time'",
            name, BOUGH_CHANNEL_NAME - 1);
        return;
    }
    assert(is_word(unit, BOUGH_CHANNEL_UNIT));
    if (bough_channels_find(list, name) >= 0) {
        list->status =
            bough_fail(BOUGH_INVALID, "two output channels are named '%s': give one another name", name);
        return;
    }
    make_room(list);
    bough_channel *channel = &list->channel[list->count++];
    memcpy(channel->name, name, BOUGH_CHANNEL_NAME);
    set_unit(channel, unit);
    channel->vector = list->count - 1;
    *slot_of(list, name) = list->count;
    list->group[list->group_count - 1].count++;
}

void bough_channels_describe(bough_channels *list, const char *meaning, int component, int divisor,
                             bough_sampling sampled) {
    if (!bough_is_ok(&list->status)) return;
    bough_channel *channel = &list->channel[list->count - 1];
    if (component > 1) channel->vector = list->count - component;
    channel->meaning = meaning;
    channel->divisor = divisor;
    channel->sampled = sampled;
}

int bough_channels_find(const bough_channels *list, const char *name) {
    return list->capacity > 0 ? *slot_of(list, name) - 1 : -1;
}

const char *const *bough_channels_names(const bough_channels *list, bough_arena *arena) {
    const char **names = bough_arena_take(arena, ((size_t)list->count + 1) * sizeof *names);
    for (int i = 0; i < list->count; i++) names[i] = list->channel[i].name;
    return names;
}

// -- choice ---------------------------------------------------------------------------------------

typedef struct choice {
    const bough_channels *all;
    int n;
    int *from;     // (n) index in `all`
    double *value; // (all->count) scratch
} choice;

static void sample_choice(void *self, double t, double *value) {
    const choice *x = self;
    bough_channels_sample(x->all, t, x->value);
    for (int k = 0; k < x->n; k++) value[k] = x->value[x->from[k]];
}

int bough_channels_choose(const bough_channels *all, int n, const char *const *pattern,
                          bough_channels *chosen) {
    bough_arena *arena = all->arena;
    bool *used = bough_arena_take(arena, (size_t)n + 1);
    *chosen = *all;
    if (n == 0) return -1;
    choice *x = bough_arena_take(arena, sizeof *x);
    x->all = all;
    x->from = bough_arena_take(arena, ((size_t)all->count + 1) * sizeof *x->from);
    x->value = bough_arena_doubles(arena, (size_t)all->count + 1);
    *chosen = bough_channels_start(arena);
    bough_channels_group(chosen, sample_choice, x);
    for (int i = 0; i < all->count; i++) {
        bool taken = false;
        for (int k = 0; k < n; k++)
            if (fnmatch(pattern[k], all->channel[i].name, 0) == 0) used[k] = taken = true;
        if (!taken) continue;
        x->from[x->n++] = i;
        bough_channels_add(chosen, all->channel[i].unit, "%s", all->channel[i].name);
    }
    for (int k = 0; k < n; k++)
        if (!used[k]) return k;
    return -1;
}

void bough_channels_know(const bough_channels *list, const double *value) { *list->known = value; }

void bough_channels_sample(const bough_channels *list, double t, double *value) {
    if (*list->known) {
        memcpy(value, *list->known, (size_t)list->count * sizeof *value);
        return;
    }
    for (int i = 0; i < list->group_count; i++) {
        const bough_channel_group *group = &list->group[i];
        if (group->count) group->sample(group->self, t, value + group->first);
    }
}
