// The functions of a monitor that the driver calls.

#ifndef PASS_H
#define PASS_H

#include <stddef.h>

typedef struct {
    const char *name;
    size_t (*load)(const char *path);    // a trace, which has a line of numbers for each sample; returns their number
    void (*run)(void);                   // one pass over the trace from its start
    void (*print)(void);                 // the results of the last pass
} Pass;

#endif
