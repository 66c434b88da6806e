// Text in double quotes as JSON, YAML 1.2 and JavaScript read it.
#ifndef BOUGH_CORE_BASE_QUOTE_H
#define BOUGH_CORE_BASE_QUOTE_H

#include <stdio.h>

// Writes the text in quotes: '<' too is escaped, which could end a script in a page; bytes that are no UTF-8
// become U+FFFD.
void bough_quote(FILE *file, const char *text);

#endif
