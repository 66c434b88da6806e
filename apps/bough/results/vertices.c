#include "apps/bough/results/vertices.h"

#ifndef BOUGH_HDF5

bough_status bough_vertices_open(bough_arena *arena, const bough_vertices_def *def,
                                 bough_vertices **vertices) {
    (void)arena, (void)def;
    *vertices = NULL;
    return bough_fail(BOUGH_INVALID, "simulation.output.vertices: this program was built without "
                                     "HDF5; configure it with -DBOUGH_HDF5=ON");
}

bough_status bough_vertices_sample(bough_vertices *vertices, double t) {
    (void)vertices, (void)t;
    return bough_ok();
}

bough_status bough_vertices_finish(bough_vertices *vertices) {
    (void)vertices;
    return bough_ok();
}

#else

#include <hdf5.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { CHUNK = 32 }; // samples

// A data set that grows along its first dimension by rows of n numbers.
typedef struct series {
    hid_t set;
    int rank;
    hsize_t row[3]; // 1, then the row's shape
} series;

struct bough_vertices {
    bough_vertices_def def;
    hid_t file; // negative once closed
    series time;
    series *position, *rotation, *force, *moment; // (n_body)
    double *x, *r, *f, *m;                        // (Σ n_point × 3), r (Σ n_point × 9)
    hsize_t n;                                    // samples so far
    char path[BOUGH_PATH_MAX], partial[BOUGH_PATH_MAX + 16];
};

static bough_status failed(const bough_vertices *v, const char *what) {
    return bough_fail(BOUGH_IO,
                      "cannot %s '%.200s' after %llu samples: HDF5 refuses, as on a full "
                      "disk",
                      what, v->partial, (unsigned long long)v->n);
}

// Whatever is left open closes with the file; a file that cannot be written is no use.
static bool close_file(bough_vertices *v) {
    hid_t file = v->file;
    v->file = -1;
    return file < 0 || H5Fclose(file) >= 0;
}

static void release(void *self) {
    bough_vertices *v = self;
    if (v->file < 0) return;
    close_file(v);
    unlink(v->partial);
}

static bool set_units(hid_t set, const char *units) {
    hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate(H5S_SCALAR);
    bool good = H5Tset_size(type, strlen(units)) >= 0;
    hid_t attribute = H5Acreate2(set, "units", type, space, H5P_DEFAULT, H5P_DEFAULT);
    good = good && attribute >= 0 && H5Awrite(attribute, type, units) >= 0;
    if (attribute >= 0) H5Aclose(attribute);
    H5Sclose(space);
    H5Tclose(type);
    return good;
}

// `row`: the shape behind the time, of `rank` − 1 numbers.
static bool create_series(hid_t file, const char *name, int rank, const hsize_t *row, const char *units,
                          series *s) {
    hsize_t none[4] = {0}, most[4] = {H5S_UNLIMITED}, chunk[4] = {CHUNK};
    for (int k = 1; k < rank; k++) none[k] = most[k] = chunk[k] = row[k - 1];
    hid_t space = H5Screate_simple(rank, none, most), how = H5Pcreate(H5P_DATASET_CREATE);
    hid_t parents = H5Pcreate(H5P_LINK_CREATE);
    bool good = H5Pset_chunk(how, rank, chunk) >= 0 && H5Pset_create_intermediate_group(parents, 1) >= 0;
    s->rank = rank;
    s->set = H5Dcreate2(file, name, H5T_IEEE_F64LE, space, parents, how, H5P_DEFAULT);
    H5Pclose(parents);
    H5Pclose(how);
    H5Sclose(space);
    s->row[0] = 1;
    for (int k = 1; k < rank && k < 3; k++) s->row[k] = row[k - 1];
    return good && s->set >= 0 && set_units(s->set, units);
}

static bool append(const series *s, hsize_t n, const double *value) {
    hsize_t size[4] = {n + 1}, start[4] = {n}, count[4] = {1, 0, 3, 3};
    for (int k = 1; k < s->rank; k++) size[k] = count[k] = k == 1 ? s->row[1] : 3;
    if (H5Dset_extent(s->set, size) < 0) return false;
    hid_t to = H5Dget_space(s->set), from = H5Screate_simple(s->rank, count, NULL);
    bool good = to >= 0 && from >= 0 &&
                H5Sselect_hyperslab(to, H5S_SELECT_SET, start, NULL, count, NULL) >= 0 &&
                H5Dwrite(s->set, H5T_NATIVE_DOUBLE, from, to, H5P_DEFAULT, value) >= 0;
    if (from >= 0) H5Sclose(from);
    if (to >= 0) H5Sclose(to);
    return good;
}

static bool create_body(bough_vertices *v, int i) {
    char name[160];
    hsize_t row[3] = {(hsize_t)v->def.body[i].n_point, 3, 3};
    snprintf(name, sizeof name, "/body/%.100s/position", v->def.body[i].name);
    if (!create_series(v->file, name, 3, row, "m", &v->position[i])) return false;
    snprintf(name, sizeof name, "/body/%.100s/rotation", v->def.body[i].name);
    if (!create_series(v->file, name, 4, row, "1", &v->rotation[i])) return false;
    snprintf(name, sizeof name, "/body/%.100s/force", v->def.body[i].name);
    if (!create_series(v->file, name, 3, row, "N", &v->force[i])) return false;
    snprintf(name, sizeof name, "/body/%.100s/moment", v->def.body[i].name);
    return create_series(v->file, name, 3, row, "N m", &v->moment[i]);
}

static bool create_file(bough_vertices *v) {
    H5dont_atexit(); // its clean-up writes again what a full disk has refused, and crashes
    hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL); // we tell errors ourselves
    H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
    v->file = H5Fcreate(v->partial, H5F_ACC_TRUNC, H5P_DEFAULT, access);
    H5Pclose(access);
    if (v->file < 0 || !create_series(v->file, "/time", 1, NULL, "s", &v->time)) return false;
    for (int i = 0; i < v->def.n_body; i++) {
        if (!create_body(v, i)) return false;
    }
    return H5Fflush(v->file, H5F_SCOPE_LOCAL) >= 0;
}

bough_status bough_vertices_open(bough_arena *arena, const bough_vertices_def *def,
                                 bough_vertices **vertices) {
    bough_vertices *v = bough_arena_take(arena, sizeof *v);
    size_t bodies = (size_t)def->n_body, points = 0;
    for (int i = 0; i < def->n_body; i++) points += (size_t)def->body[i].n_point;
    series *each = bough_arena_take(arena, 4 * bodies * sizeof *each);
    double *x = bough_arena_doubles(arena, 18 * points);
    *v = (bough_vertices){.def = *def,
                          .file = -1,
                          .position = each,
                          .rotation = each + bodies,
                          .force = each + 2 * bodies,
                          .moment = each + 3 * bodies,
                          .x = x,
                          .r = x + 3 * points,
                          .f = x + 12 * points,
                          .m = x + 15 * points};
    bough_status status = bough_folder_path(def->folder, "vertices.h5", v->path);
    if (!bough_is_ok(&status)) return status;
    snprintf(v->partial, sizeof v->partial, "%s.partial", v->path);
    bough_arena_on_destroy(arena, release, v);
    *vertices = v;
    return create_file(v) ? bough_ok() : failed(v, "create");
}

bough_status bough_vertices_sample(bough_vertices *v, double t) {
    v->def.motion(v->def.self, v->x, v->r);
    v->def.loads(v->def.self, t, v->f, v->m);
    bool good = append(&v->time, v->n, &t);
    int first = 0;
    for (int i = 0; i < v->def.n_body && good; first += v->def.body[i++].n_point) {
        good = append(&v->position[i], v->n, v->x + 3 * first) &&
               append(&v->rotation[i], v->n, v->r + 9 * first) &&
               append(&v->force[i], v->n, v->f + 3 * first) && append(&v->moment[i], v->n, v->m + 3 * first);
    }
    if (!good) return failed(v, "write");
    v->n++;
    return bough_ok();
}

bough_status bough_vertices_finish(bough_vertices *v) {
    bool flushed = H5Fflush(v->file, H5F_SCOPE_LOCAL) >= 0;
    bool closed = close_file(v);
    if (flushed && closed) return bough_folder_commit(v->path, NULL);
    unlink(v->partial);
    return failed(v, "finish");
}

#endif
