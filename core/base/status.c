#include "core/base/status.h"

// Not an initialiser, which would clear the whole message.
bough_status bough_ok(void) {
    bough_status status;
    status.code = BOUGH_OK;
    status.message[0] = '\0';
    return status;
}

// Marks a message that was cut, at a word.
static void end_after_word(char *message) {
    static const char more[] = " ...";
    char *end = message + BOUGH_MESSAGE - sizeof more;
    while (end > message + BOUGH_MESSAGE / 2 && *end != ' ') end--;
    memcpy(end, more, sizeof more);
}

bough_status bough_fail(bough_code code, const char *format, ...) {
    bough_status status = {.code = code};
    va_list arguments;
    va_start(arguments, format);
    // vsnprintf returns the length that the whole message would have
    int length = vsnprintf(status.message, sizeof status.message, format, arguments);
    va_end(arguments);
    if (length >= (int)sizeof status.message) end_after_word(status.message);
    return status;
}

// 2: bad input; 3: numerical failure; 130: interrupted; 1: files or memory.
int bough_exit_code(bough_code code) {
    switch (code) {
    case BOUGH_OK: return 0;
    case BOUGH_INVALID: return 2;
    case BOUGH_RETRY:
    case BOUGH_FAILED: return 3;
    case BOUGH_INTERRUPTED: return 130;
    case BOUGH_IO:
    case BOUGH_OUT_OF_MEMORY: break;
    }
    return 1;
}
