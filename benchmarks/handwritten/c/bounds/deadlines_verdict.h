// Two deadlines of 5 s at 60 Hz, as Copilot and R2U2 keep them: a counter for each, and nothing but the verdict.

#include "verdicts.h"

typedef struct { bool alarm, hidden, out; } Signals;
typedef unsigned char Result;
typedef struct { uint16_t alarm, hidden; bool violated; } Monitor;

static inline void monitor_reset(Monitor *monitor) {
    *monitor = (Monitor){0, 0, false};
}

static inline bool monitor_step(Monitor *monitor, const Signals *sample, Result *result) {
    monitor->alarm = waited(monitor->alarm, sample->alarm, sample->hidden, 301);
    monitor->hidden = waited(monitor->hidden, sample->hidden, sample->out, 301);
    monitor->violated |= monitor->alarm > 300 || monitor->hidden > 300;
    *result = monitor->violated ? VIOLATED : monitor->alarm || monitor->hidden ? PENDING : HOLDING;
    return true;
}

static void print_result(const Result *result) {
    puts(verdict_names[*result]);
}
