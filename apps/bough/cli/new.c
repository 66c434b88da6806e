// bough new: writes one of the built-in scenes, commented and complete with its tables.
#include "apps/bough/cli/command.h"
#include "apps/bough/config/schema.h"
#include "apps/bough/results/folder.h"

#include <dirent.h>
#include <errno.h>
#include <sys/stat.h>

static const char *const kinds[] = {"beam", "mechanism", "turbine", NULL};

static bool belongs(const bough_template *t, const char *kind) {
    size_t length = strlen(kind);
    return strncmp(t->name, kind, length) == 0 && t->name[length] == '/';
}

// The directory is made, or is there and empty.
static bough_status open_directory(const char *path) {
    if (mkdir(path, 0777) == 0) return bough_ok();
    if (errno != EEXIST) return bough_fail(BOUGH_IO, "cannot make '%.200s': %s", path, strerror(errno));
    DIR *folder = opendir(path);
    if (!folder) return bough_fail(BOUGH_INVALID, "'%.200s' is not a directory: %s", path, strerror(errno));
    bool empty = true;
    for (struct dirent *entry; (entry = readdir(folder)) != NULL;)
        empty = empty && (strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0);
    closedir(folder);
    return empty ? bough_ok()
                 : bough_fail(BOUGH_INVALID, "'%.200s' is not empty; name a new directory", path);
}

static void put_text(const void *template, FILE *file) {
    fputs(((const bough_template *)template)->text, file);
}

// All files of the kind, or none: a directory without the tables would look like a complete scene.
static bough_status write_files(const char *folder, const char *kind) {
    bough_status status = bough_ok();
    for (const bough_template *t = bough_templates; t->name && bough_is_ok(&status); t++)
        if (belongs(t, kind)) status = bough_folder_write(folder, strchr(t->name, '/') + 1, put_text, t);
    if (bough_is_ok(&status)) return status;
    for (const bough_template *t = bough_templates; t->name; t++)
        if (belongs(t, kind)) (void)bough_folder_remove(folder, strchr(t->name, '/') + 1);
    bough_folder_clean(folder);
    return status;
}

static bough_status new (bough_arena *arena, const void *given) {
    (void)arena;
    const bough_options *options = given;
    bool known = false;
    for (const char *const *kind = kinds; *kind; kind++)
        known = known || strcmp(*kind, options->operand) == 0;
    if (!known)
        return bough_fail(BOUGH_INVALID, "new: unknown kind '%.80s'%s; known: beam, mechanism, turbine",
                          options->operand, bough_suggest(options->operand, kinds, 3).text);
    BOUGH_TRY(open_directory(options->operands[1]));
    BOUGH_TRY(write_files(options->operands[1], options->operand));
    printf("scene: %s/scene.yaml\nnext: bough run %s\n", options->operands[1], options->operands[1]);
    return bough_ok();
}

const bough_command bough_command_new = {
    .name = "new",
    .summary =
        "writes a commented scene that runs, of a beam, a mechanism or a turbine, into a new directory",
    .operands = "KIND DIR",
    .size = sizeof(bough_options),
    .run = new,
};
