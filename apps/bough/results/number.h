// Numbers in rows of results, as printf writes them but several times faster.
#ifndef BOUGH_OUTPUT_NUMBER_H
#define BOUGH_OUTPUT_NUMBER_H

// Writes x as printf's "%*.8E" does, into exactly `width` characters (at least 16) and a terminator.
void bough_number_write(char *to, int width, double x);

#endif
