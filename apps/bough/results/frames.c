#include "apps/bough/results/frames.h"

#include <dirent.h>
#include <unistd.h>

struct bough_frames {
    bough_frames_def def;
    bough_growing list;             // frames.pvd
    double *point, *force, *moment; // (n_point × 3)
    int n_point;
};

bough_status bough_frames_open(bough_arena *arena, const bough_frames_def *def, bough_frames **frames) {
    bough_frames *f = bough_arena_take(arena, sizeof *f);
    f->def = *def;
    for (int k = 0; k < def->n_line; k++) f->n_point += def->line[k].n_point;
    f->point = bough_arena_doubles(arena, 9 * (size_t)f->n_point);
    f->force = f->point + 3 * f->n_point;
    f->moment = f->force + 3 * f->n_point;
    char folder[BOUGH_PATH_MAX];
    BOUGH_TRY(bough_folder_path(def->folder, "frames", folder));
    BOUGH_TRY(bough_folder_make(folder));
    if (def->kept.count == 0) BOUGH_TRY(bough_folder_remove(def->folder, "frames.pvd"));
    BOUGH_TRY(bough_growing_open(arena, def->folder, "frames.pvd", def->kept, &f->list));
    if (def->kept.count == 0)
        fputs("<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n",
              f->list.file);
    *frames = f;
    return bough_ok();
}

static void write_vectors(const bough_frames *f, const char *name, const double *x, FILE *file) {
    fprintf(file, "<DataArray type=\"Float32\" Name=\"%s\" NumberOfComponents=\"3\" format=\"ascii\">\n",
            name);
    for (int i = 0; i < f->n_point; i++, x += 3) fprintf(file, "%.6g %.6g %.6g\n", x[0], x[1], x[2]);
    fprintf(file, "</DataArray>\n");
}

static void write_lines(const bough_frames *f, FILE *file) {
    fprintf(file, "<Lines>\n<DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">\n");
    for (int i = 0; i < f->n_point; i++) fprintf(file, "%d\n", i);
    fprintf(file, "</DataArray>\n<DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">\n");
    int end = 0;
    for (int k = 0; k < f->def.n_line; k++) fprintf(file, "%d\n", end += f->def.line[k].n_point);
    fprintf(file, "</DataArray>\n</Lines>\n");
}

// Which body a line belongs to, by number, with the names beside it.
static void write_bodies(const bough_frames *f, FILE *file) {
    fprintf(file, "<CellData>\n<DataArray type=\"Int32\" Name=\"body\" format=\"ascii\">\n");
    for (int k = 0; k < f->def.n_line; k++) fprintf(file, "%d\n", k);
    fprintf(file, "</DataArray>\n</CellData>\n<!--");
    for (int k = 0; k < f->def.n_line; k++) fprintf(file, " %s", f->def.line[k].name);
    fprintf(file, " -->\n");
}

// The report reads points, lines and loads in this order.
static void write_frame(const void *self, FILE *file) {
    const bough_frames *f = self;
    fprintf(file,
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\">\n"
            "<PolyData>\n<Piece NumberOfPoints=\"%d\" NumberOfLines=\"%d\">\n<Points>\n",
            f->n_point, f->def.n_line);
    write_vectors(f, "position", f->point, file);
    fprintf(file, "</Points>\n");
    write_lines(f, file);
    fprintf(file, "<PointData>\n");
    write_vectors(f, "section force (N)", f->force, file);
    write_vectors(f, "section moment (N m)", f->moment, file);
    fprintf(file, "</PointData>\n");
    write_bodies(f, file);
    fprintf(file, "</Piece>\n</PolyData>\n</VTKFile>\n");
}

bough_status bough_frames_sample(bough_frames *f, double t) {
    char name[32];
    snprintf(name, sizeof name, "frames/%06ld.vtp", f->list.count);
    f->def.points(f->def.self, f->point);
    f->def.loads(f->def.self, t, f->force, f->moment);
    BOUGH_TRY(bough_folder_write(f->def.folder, name, write_frame, f));
    fprintf(f->list.file, "<DataSet timestep=\"%.9g\" file=\"%s\"/>\n", t, name);
    f->list.count++;
    return bough_ok();
}

bough_status bough_frames_keep(bough_frames *f, bough_kept *kept) {
    return bough_growing_keep(&f->list, kept);
}

// Removes the frames from number n on: files with exactly the names of frames.
static bough_status remove_from(const char *folder, long n) {
    char path[BOUGH_PATH_MAX], name[32];
    bough_status status = bough_folder_path(folder, "frames", path);
    DIR *directory = bough_is_ok(&status) ? opendir(path) : NULL;
    if (!directory) return status;
    for (const struct dirent *entry; bough_is_ok(&status) && (entry = readdir(directory)) != NULL;) {
        int number = atoi(entry->d_name);
        snprintf(name, sizeof name, "%06d.vtp", number);
        if (number >= n && strcmp(name, entry->d_name) == 0) status = bough_folder_remove(path, name);
    }
    closedir(directory);
    if (n == 0) rmdir(path); // where nothing else is in it
    return status;
}

bough_status bough_frames_remove(const char *folder) {
    BOUGH_TRY(bough_folder_remove(folder, "frames.pvd"));
    return remove_from(folder, 0);
}

bough_status bough_frames_finish(bough_frames *f) {
    BOUGH_TRY(remove_from(f->def.folder, f->list.count));
    fputs("</Collection>\n</VTKFile>\n", f->list.file);
    return bough_growing_finish(&f->list);
}
