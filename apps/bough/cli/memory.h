// How much memory the process has used.
#ifndef BOUGH_APPS_BOUGH_MEMORY_H
#define BOUGH_APPS_BOUGH_MEMORY_H

// The process's largest resident memory so far [bytes]; 0 when the system does not tell.
long long bough_peak_memory(void);

#endif
