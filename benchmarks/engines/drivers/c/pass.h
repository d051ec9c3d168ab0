// The functions of a monitor that the driver calls.

#ifndef PASS_H
#define PASS_H

#include <stddef.h>

typedef struct {
    const char *name;
    void (*load)(const double *numbers, size_t count);    // the samples of a trace, one after another
    void (*run)(void);                                     // one pass over the trace from its start
    double (*rewards)(void);                               // the sum over the last pass
    void (*print)(void);                                   // the results of the last pass
} Pass;

extern const Pass generated, by_hand;

#endif
