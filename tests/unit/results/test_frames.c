// Frames for ParaView, and the page that shows them.
#include "tests/unit/scratch.h"

#include "apps/bough/results/frames.h"
#include "apps/bough/results/report.h"

static void points(void *self, double *point) {
    const double *shift = self;
    for (int i = 0; i < 5; i++) {
        point[3 * i] = i + *shift;
        point[3 * i + 1] = -0.5 * i;
        point[3 * i + 2] = 2;
    }
}

static void loads(void *self, double t, double *force, double *moment) {
    (void)self;
    for (int i = 0; i < 15; i++) force[i] = 100 * t + i, moment[i] = -force[i];
}

static void write_frames(const char *folder) {
    static const bough_polyline line[] = {{"first", 3}, {"second", 2}};
    double shift = 0;
    check_arena(arena);
    bough_frames_def def = {
        .folder = folder, .n_line = 2, .line = line, .points = points, .loads = loads, .self = &shift};
    bough_frames *frames;
    check_ok(bough_frames_open(arena, &def, &frames));
    for (int k = 0; k < 2; k++, shift += 0.25) {
        check_ok(bough_frames_sample(frames, 0.1 * k));
    }
    check_ok(bough_frames_finish(frames));
}

static void has(const char *text, const char *part) {
    if (strstr(text, part) == NULL) fail_msg("'%s' is missing in\n%s", part, text);
}

TEST_IN_FOLDER(frames_are_polylines_with_times) {
    const char *folder = *context;
    write_frames(folder);
    char *list = scratch_read(folder, "frames.pvd");
    has(list, "<DataSet timestep=\"0\" file=\"frames/000000.vtp\"/>\n"
              "<DataSet timestep=\"0.1\" file=\"frames/000001.vtp\"/>\n</Collection>");
    char *frame = scratch_read(folder, "frames/000001.vtp");
    has(frame, "NumberOfPoints=\"5\" NumberOfLines=\"2\"");
    has(frame, "\n0.25 -0 2\n1.25 -0.5 2\n2.25 -1 2\n3.25 -1.5 2\n4.25 -2 2\n</DataArray>");
    has(frame, "<PointData>\n<DataArray type=\"Float32\" Name=\"section force (N)\" "
               "NumberOfComponents=\"3\" format=\"ascii\">\n10 11 12\n13 14 15\n");
    has(frame, "Name=\"section moment (N m)\" NumberOfComponents=\"3\" format=\"ascii\">\n-10 -11");
    has(frame, "Name=\"offsets\" format=\"ascii\">\n3\n5\n");
    free(list);
    free(frame);
}

static const char channels[] = "\nbough: a run\nComplete: 2 rows\n\n1 channel\n\n"
                               "  Time\tRotSpeed\n (s)\t(rpm)\n 0.0E+00\t 1.25\n 1.0E-01\t-2.5\n";

TEST_IN_FOLDER(page_carries_all_data) {
    check_arena(arena);
    const char *folder = *context;
    write_frames(folder);
    scratch_write(folder, "channels.out", channels);
    scratch_write(folder, "summary.json", "{\"title\": \"a </script> trap\"}\n");
    check_ok(bough_report_write(arena, 1, &folder));
    char *page = scratch_read(folder, "report.html");
    has(page, "<!DOCTYPE html>");
    has(page, "data.summary = \"{\\\"title\\\": \\\"a \\u003c/script> trap\\\"}\\n\";");
    has(page, "{names: [\"Time\",\"RotSpeed\"], units: [\"s\",\"rpm\"], rows: [\n[0,1.25],\n"
              "[0.1,-2.5],\n]};");
    has(page, "[0.1,0.25,-0,2,1.25,-0.5,2,");
    has(page, "ends: [3,5,]");
    has(page, "</html>");
    assert_null(strstr(page, "@DATA@"));
    assert_null(strstr(page, "http")); // nothing is fetched
    free(page);
}

TEST_IN_FOLDER(what_is_not_results_is_refused) {
    check_arena(arena);
    const char *folder = *context;
    check_fails(bough_report_write(arena, 1, &folder), BOUGH_INVALID, "holds no results");
    scratch_write(folder, "channels.out", "\n\n\n\n\n\nTime\tA\n(s)\t(m)\n0.0 1.0\n0.1\n");
    check_fails(bough_report_write(arena, 1, &folder), BOUGH_INVALID, "channels.out:10: not a row");
    assert_false(scratch_has(folder, "report.html"));
}

TEST_IN_FOLDER(a_lost_frame_is_reported) {
    check_arena(arena);
    const char *folder = *context;
    write_frames(folder);
    scratch_write(folder, "frames/000001.vtp", "<DataArray>\nnothing\n");
    check_fails(bough_report_write(arena, 1, &folder), BOUGH_INVALID, "frames/000001.vtp");
}
