#include "aero/wind/wind_box.h"
#include "aero/wind/wind_hub.h"
#include "tests/fuzz/fuzz.h"

// Any bytes as either wind file; what is accepted can be asked anywhere.
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    bough_arena *arena = bough_arena_create();
    bough_wind_box box;
    bough_wind_hub hub;
    const char *path = fuzz_file("wind", data, size);
    bough_status as_box = bough_wind_box_read(arena, path, &box);
    bough_status as_hub = bough_wind_hub_read(arena, path, &hub);
    // A row of the shortest line that might be one, two bytes, takes 72.
    fuzz_demand(bough_arena_bytes(arena) < 40 * size + 10000, "memory in proportion");
    for (int i = 0; i < 27; i++) {
        const double place[] = {-1e30, 12.3, 1e30};
        bough_vec3 p = bough_v3(place[i % 3], place[i / 3 % 3], place[i / 3 % 3]);
        if (bough_is_ok(&as_box)) bough_wind_box_at(&box, p, place[i / 9]);
        if (bough_is_ok(&as_hub)) bough_wind_hub_at(&hub, p, place[i / 9]);
    }
    bough_arena_destroy(arena);
    return 0;
}
