// Text in double quotes as JSON, YAML 1.2 and JavaScript read it.
#pragma once

#include <stdio.h>

// Writes the text in quotes: '<' too is escaped, which could end a script in a page; bytes that are no UTF-8
// become U+FFFD.
void bough_quote(FILE *file, const char *text);
