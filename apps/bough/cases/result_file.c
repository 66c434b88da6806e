#include "apps/bough/cases/result_file.h"

#include "apps/bough/results/folder.h"
#include "core/base/input_file.h"

#include <errno.h>
#include <inttypes.h>
#include <string.h>

bough_status bough_result_folder(const char *folder) {
    char path[BOUGH_PATH_MAX];
    bough_status status = bough_folder_path(folder, "cases", path);
    return bough_is_ok(&status) ? bough_folder_make(path) : status;
}

static bough_status path_of(const bough_result_file *file, char path[BOUGH_PATH_MAX]) {
    char name[48];
    snprintf(name, sizeof name, "cases/%s.case", file->name);
    return bough_folder_path(file->folder, name, path);
}

// -- writing --------------------------------------------------------------------------------------

void bough_result_text(FILE *stream, const char *word, const char *text) {
    fprintf(stream, "%s ", word);
    for (const char *c = text; *c; c++) fputc(*c == '\n' || *c == '\r' ? ' ' : *c, stream);
    fputc('\n', stream);
}

void bough_result_put(FILE *stream, const char *word, int n, const double *x) {
    fputs(word, stream);
    for (int i = 0; i < n; i++) fprintf(stream, " %.17g", x[i]);
    fputc('\n', stream);
}

bough_status bough_result_write(const bough_result_file *file, const bough_status *outcome,
                                void (*put)(const void *self, FILE *stream), const void *self) {
    char path[BOUGH_PATH_MAX];
    FILE *stream;
    bough_status status = path_of(file, path);
    if (bough_is_ok(&status)) status = bough_folder_open_partial(path, &stream);
    if (!bough_is_ok(&status)) return status;
    fprintf(stream, "case %s fingerprint %016" PRIx64 "\noutcome ", file->name, file->fingerprint);
    char code[12];
    snprintf(code, sizeof code, "%d", (int)outcome->code);
    bough_result_text(stream, code, bough_is_ok(outcome) ? "" : outcome->message);
    put(self, stream);
    fputs("end\n", stream);
    return bough_folder_commit(path, stream);
}

// -- reading --------------------------------------------------------------------------------------

static bool take_word(FILE *stream, const char *word) {
    char found[32];
    return fscanf(stream, "%31s", found) == 1 && strcmp(found, word) == 0;
}

bool bough_result_take(FILE *stream, const char *word, int n, double *x) {
    if (!take_word(stream, word)) return false;
    for (int i = 0; i < n; i++)
        if (fscanf(stream, "%lf", &x[i]) != 1) return false;
    return true;
}

static bool take_head(const bough_result_file *file, FILE *stream, bough_status *outcome) {
    uint64_t fingerprint;
    int code;
    char name[24], message[BOUGH_MESSAGE] = "";
    if (fscanf(stream, "case %23s fingerprint %" SCNx64 " outcome %d", name, &fingerprint, &code) != 3)
        return false;
    if (!fgets(message, sizeof message, stream)) return false;
    message[strcspn(message, "\n")] = '\0';
    *outcome = code == BOUGH_OK ? bough_ok() : bough_fail((bough_code)code, "%s", message + 1);
    return strcmp(name, file->name) == 0 && fingerprint == file->fingerprint;
}

bough_status bough_result_open(const bough_result_file *file, bough_status *outcome, FILE **stream) {
    char path[BOUGH_PATH_MAX], why[BOUGH_INPUT_REASON];
    *stream = NULL;
    bough_status status = path_of(file, path);
    if (!bough_is_ok(&status)) return status;
    errno = 0;
    FILE *found = bough_input_open(path, BOUGH_INPUT_DATA, why);
    if (!found && errno != ENOENT) return bough_fail(BOUGH_IO, "cannot read '%.200s': %s", path, why);
    if (found && take_head(file, found, outcome))
        *stream = found;
    else if (found)
        fclose(found);
    return status;
}

bough_status bough_result_close(const bough_result_file *file, FILE *stream, bool good) {
    good = good && take_word(stream, "end");
    fclose(stream);
    if (good) return bough_ok();
    return bough_fail(BOUGH_IO,
                      "the result '%.200s/cases/%s.case' is damaged: remove it, and the same command "
                      "runs the case again",
                      file->folder, file->name);
}
