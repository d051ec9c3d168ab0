// What the driver asks of each monitor.

#ifndef PASS_H
#define PASS_H

#include <stddef.h>

typedef struct {
    const char *name;
    void (*load)(const double *numbers, size_t count);    // the samples of a trace, one behind the other
    void (*run)(void);                                     // one pass over it from its beginning
    double (*rewards)(void);                               // the sum over the last pass
    void (*print)(void);                                   // what the last pass gave
} Pass;

extern const Pass generated, by_hand;

#endif
