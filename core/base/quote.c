// Texts as JSON strings, valid UTF-8 whatever they contain.
#include "core/base/quote.h"

// Bytes of the UTF-8 character at `text`, 0 if there is none: names of files need not be text.
static int character_length(const unsigned char *text) {
    int length = text[0] < 0x80   ? 1
                 : text[0] < 0xC2 ? 0
                 : text[0] < 0xE0 ? 2
                 : text[0] < 0xF0 ? 3
                 : text[0] < 0xF5 ? 4
                                  : 0;
    // its further bytes
    for (int i = 1; i < length; i++) {
        if ((text[i] & 0xC0) != 0x80) return 0;
    }
    return length;
}

void bough_quote(FILE *file, const char *text) {
    fputc('"', file);
    for (const unsigned char *c = (const unsigned char *)text; *c;) {
        // a byte that begins no character becomes U+FFFD
        int length = character_length(c);
        if (length == 0) {
            fputs("\\ufffd", file);
        } else if (*c == '"' || *c == '\\') {
            fprintf(file, "\\%c", *c);
        } else if (*c == '\n') {
            fputs("\\n", file);
        } else if (*c < 0x20 || *c == '<') {
            fprintf(file, "\\u%04x", (unsigned)*c);
        } else {
            fwrite(c, 1, (size_t)length, file);
        }
        c += length > 0 ? length : 1;
    }
    fputc('"', file);
}
