// The result of the handwritten monitors, and closeness.  C99 and C++17.

#ifndef BY_HAND_COMMON_H
#define BY_HAND_COMMON_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

typedef enum { SATISFIED, HOLDING, PENDING, VIOLATED } Verdict;

typedef struct {
    int state;
    const char *label;
    Verdict verdict;
    bool accepting;
    bool done;
    double progress;
    double reward;
    double robustness;
    const char *limiting;    // NULL for none
    const char *label_english;
    const char *failed_clause;    // NULL for none
    const char *failed_atom;      // NULL for none
    int failed_step;              // 0 for none
} Result;

typedef struct {
    double level_size;
    int state;
    int steps;
    double progress;
    bool done;
    int failed_step;
    const char *problem;    // why the last sample was refused
} Monitor;

static inline const char *verdict_name(Verdict verdict) {
    static const char *const names[] = {"satisfied", "holding", "pending", "violated"};
    return names[verdict];
}

static inline void monitor_reset(Monitor *monitor) {
    monitor->state = 0;
    monitor->steps = 0;
    monitor->progress = 0.0;
    monitor->done = false;
    monitor->failed_step = 0;
    monitor->problem = NULL;
}

static inline void monitor_init(Monitor *monitor, double level_size) {
    monitor->level_size = level_size;
    monitor_reset(monitor);
}

static inline bool monitor_refuse(Monitor *monitor, const char *problem) {
    monitor->problem = problem;
    return false;
}

// Writes what the trace fails at after a step: in the trap, the one clause that a trace must not break.
static inline void monitor_tell(Monitor *monitor, bool trapped, Result *result) {
    if (trapped && !monitor->failed_step) monitor->failed_step = monitor->steps;
    result->failed_clause = trapped ? "keep alive" : NULL;
    result->failed_atom = trapped ? "alive" : NULL;
    result->failed_step = monitor->failed_step;
}

// Closeness in [-1, 1]: 1 at the target, 0 at 1 m, -1 from level_size on.
static inline double near_to(double distance, double level_size) {
    if (distance < 1.0) return distance > 0.0 ? 1.0 - distance : 1.0;
    if (distance > level_size) return -1.0;
    const double rest = (level_size - distance) / (level_size - 1.0);
    return rest * rest - 1.0;
}

static inline double least(double x, double y) {
    return x < y ? x : y;
}

static inline double greatest(double x, double y) {
    return x > y ? x : y;
}

#endif
