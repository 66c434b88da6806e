// Bad modes, turbines, winds and polars, each reported at its place.
#include "tests/unit/scene_text.h"

TEST(modes_name_their_axis) {
    refuses(TWO_RODS "  []\nmodes: {about: x, axis: [0, 0, 1]}\n",
            "s.yaml:8:16: error: modes.about: there is no body 'x' (did you mean 'a'?)\n"
            "s.yaml:8:25: error: modes.axis: only used without 'about'\n");
    refuses(TWO_RODS "  []\nmodes: {about: a, centre: [0, 0, 1], count: 0}\n",
            "s.yaml:8:16: error: modes.about: the joint of 'a' must be revolute\n"
            "s.yaml:8:27: error: modes.centre: only used with 'axis'\n"
            "s.yaml:8:45: error: modes.count: must be in [1, 60], got '0'\n");
    refuses(TWO_RODS "  []\nmodes: {speed: 10 rpm, axis: [0, 0, 0]}\n",
            "s.yaml:8:30: error: modes.axis: must not be zero\n");
    accepts(TWO_RODS "  []\nmodes: {speed: 10 rpm, about: c, shapes: true}\n");
}

#define AERO                                                                                                 \
    "aero: {rate: 50 Hz, wind: {speed: 8}, blade: aero.yaml, polars: polars.yaml, hub_radius: "              \
    "1}\n"
#define BLADE "stations:\n- {span: 0, chord: 1, polar: p}\n- {span: 5, chord: 1, polar: p}\n"
#define POLARS                                                                                               \
    "polars:\n- name: p\n  table: {columns: [alpha deg, cl, cd, cm], rows: [[-180, 0, 0, 0], "               \
    "[180, 0, 0, 0]]}\n"

TEST(turbine_names_are_checked) {
    refuses(ROTOR "turbine: {rotor: hbu, blades: [b1, b3]}\n",
            "s.yaml:7:18: error: turbine.rotor: there is no body 'hbu' (did you mean 'hub'?)\n"
            "s.yaml:7:36: error: turbine.blades[1]: there is no body 'b3' (did you mean 'b1'?)\n");
    refuses(ROTOR "turbine: {rotor: b1, blades: [b1, b1, hub]}\n",
            "s.yaml:7:18: error: turbine.rotor: the joint of 'b1' must be revolute\n"
            "s.yaml:7:35: error: turbine.blades[1]: blade 'b1' is given twice\n"
            "s.yaml:7:39: error: turbine.blades[2]: body 'hub' has no rod, so it cannot be a blade\n");
    refuses(ROTOR "turbine: {rotor: hub, blades: [b1, b2]}\n",
            "s.yaml:7:36: error: turbine.blades[1]: body 'b2' is not carried by the rotor 'hub'\n");
}

TEST(aerodynamics_are_consistent) {
    write_file("aero.yaml", BLADE);
    write_file("polars.yaml", POLARS);
    accepts(ROTOR "turbine: {rotor: hub, blades: [b1]}\n" AERO);
    refuses(ROTOR AERO, "s.yaml:7:7: error: aero: needs 'turbine', which names rotor and blades\n");
    refuses(ROTOR "turbine: {rotor: hub, blades: [b1]}\n"
                  "aero: {rate: 30 Hz, wind: {speed: 8}, blade: aero.yaml, polars: polars.yaml,\n"
                  "       hub_radius: 1, ramp: [1, 0], tower: {height: [0, 20, 10], diameter: [1, 2]}}\n",
            "s.yaml:8:14: error: aero.rate: its period 0.0333333 s is not a multiple of the macro "
            "step, 0.01 s\n"
            "s.yaml:9:29: error: aero.ramp: must end after it starts, got [1 s, 0 s]\n"
            "s.yaml:9:61: error: aero.tower.height[2]: must be more than '20' before it, got '10'\n"
            "s.yaml:9:76: error: aero.tower.diameter: has 2 values, but height has 3\n");
    refuses(ROTOR "turbine: {rotor: hub, blades: [b1]}\n"
                  "aero: {rate: 50 Hz, wind: {speed: 8}, blade: aero.yaml, polars: polars.yaml,\n"
                  "       hub_radius: 1, tower: {height: [0, 10, 20], diameter: [1, 1, 1], drag: [1, 2]}}\n",
            "s.yaml:9:79: error: aero.tower.drag: has 2 values, but height has 3; give one or as many\n");
    write_file("aero.yaml", "stations:\n- {span: 0, chord: 1, polar: p}\n"
                            "- {span: 6, chord: 0, polar: q}\n");
    refuses(ROTOR "turbine: {rotor: hub, blades: [b1]}\n" AERO,
            "s.yaml:8:46: error: aero.blade: the blade elements end at 6 m, but 'b1' is 5 m long\n"
            "aero.yaml:3:20: error: stations[1].chord: must be > 0 m, got '0'\n"
            "aero.yaml:3:30: error: stations[1].polar: the polars file has no 'q' (did you mean 'p'?)\n");
    write_file("aero.yaml", "stations:\n- {span: 0, chord: 1, polar: p}\n"
                            "- {span: 0, chord: 1, polar: p}\n");
    refuses(ROTOR AERO, "s.yaml:7:7: error: aero: needs 'turbine', which names rotor and blades\n"
                        "aero.yaml:3:10: error: stations[1].span: must be more than '0' before it, "
                        "got '0'\n");
}

#define WIND(keys)                                                                                           \
    ROTOR "turbine: {rotor: hub, blades: [b1]}\n"                                                            \
          "aero:\n  rate: 50 Hz\n  blade: aero.yaml\n  polars: polars.yaml\n"                                \
          "  hub_radius: 1\n"                                                                                \
          "  wind: {" keys "}\n"

TEST(wind_is_a_speed_or_a_table) {
    write_file("aero.yaml", BLADE);
    write_file("polars.yaml", POLARS);
    accepts(WIND("table: {times: [0, 10 s], speeds: [8, 9]}, direction: 5 deg, vertical: -1"));
    accepts(WIND("kind: power, speed: 8, exponent: 0.14, reference_height: 90"));
    refuses(WIND("direction: 0"), "s.yaml:13:9: error: aero.wind: required key 'speed' is missing "
                                  "(without a table)\n");
    refuses(WIND("speed: 8, table: {times: [0, 1], speeds: [8, 9]}"),
            "s.yaml:13:17: error: aero.wind.speed: only used without a table\n");
    refuses(WIND("table: {times: [0, 1, 1], speeds: [8, 9]}"),
            "s.yaml:13:32: error: aero.wind.table.times[2]: must be more than '1' before it, got '1'\n"
            "s.yaml:13:44: error: aero.wind.table.speeds: has 2 values, but times has 3\n");
    refuses(WIND("speed: 8, kind: log, reference_height: 1, roughness: 2"),
            "s.yaml:13:49: error: aero.wind.reference_height: must be more than the roughness, "
            "2 m, got 1 m\n");
}

TEST(polars_cover_the_circle) {
    write_file("aero.yaml", BLADE);
    write_file("polars.yaml", "polars:\n- name: p\n  table:\n    columns: [alpha deg, cl, cd, cm]\n"
                              "    rows:\n    - [-180, 0, 0, 0]\n    - [-180, 0, 0, 0]\n"
                              "    - [180, 0, 0, 0]\n");
    refuses(ROTOR "turbine: {rotor: hub, blades: [b1]}\n" AERO,
            "polars.yaml:7:8: error: polars[0].table.rows[1].alpha: must be more than '-180' "
            "before it, got '-180'\n");
    write_file("polars.yaml", "polars:\n- name: p\n  table:\n    columns: [alpha deg, cl, cd, cm]\n"
                              "    rows:\n    - [-180, 0, 0, 0]\n    - [90, 0, 0, 0]\n"
                              "- name: r\n  table:\n    columns: [alpha deg, cl, cd, cm]\n"
                              "    rows:\n    - [0, 0, 0, 0]\n    - [180, 0, 0, x]\n"
                              "- name: s\n  table: [{alpha: 0, cl: 0, cd: 0, cm: 0}, "
                              "{alpha: 180 deg, cl: 0, cd: 0, cm: 0}]\n");
    refuses(ROTOR "turbine: {rotor: hub, blades: [b1]}\n" AERO,
            "polars.yaml:7:8: error: polars[0].table.rows[1].alpha: the last must be 180 deg, got 90 deg\n"
            "polars.yaml:13:19: error: polars[1].table.rows[1].cm: expected a number, got 'x'\n"
            "polars.yaml:15:19: error: polars[2].table[0].alpha: the first must be -180 deg, got 0 deg\n");
    write_file("polars.yaml", POLARS "- name: p\n  table: [{alpha: -180 deg, cl: 0, cd: 0, cm: 0}, "
                                     "{alpha: 180 deg, cl: 0, cd: 0, cm: 0}]\n");
    refuses(ROTOR "turbine: {rotor: hub, blades: [b1]}\n" AERO,
            "polars.yaml:4:9: error: polars[1].name: polar 'p' is given twice\n");
}

GROUP(enter, leave)
