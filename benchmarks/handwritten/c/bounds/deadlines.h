// Two deadlines of 5 s at 60 Hz, with every field of a generated monitor.

#include "results.h"

typedef struct { bool alarm, hidden, out; } Signals;
typedef struct { uint16_t alarm, hidden; Verdict verdict; History history; } Monitor;

static inline void monitor_reset(Monitor *monitor) {
    *monitor = (Monitor){.verdict = HOLDING};
}

static inline bool monitor_step(Monitor *monitor, const Signals *sample, Result *result) {
    static const char label[] =
        "G(!late(5 s, alarm, hidden) & (due(alarm, hidden) -> X true) & "
        "!late(5 s, hidden, out) & (due(hidden, out) -> X true))";
    static const char english[] =
        "Whenever alarm, reach hidden within 5 s; and whenever hidden, reach out within 5 s.";
    static const Failure failures[] = {
        {"keep alarm implies eventually within 5 s hidden", "late(5 s, alarm, hidden)"},
        {"keep hidden implies eventually within 5 s out", "late(5 s, hidden, out)"},
    };
    monitor->history.steps++;
    monitor->alarm = waited(monitor->alarm, sample->alarm, sample->hidden, 601);
    monitor->hidden = waited(monitor->hidden, sample->hidden, sample->out, 601);
    if (monitor->verdict == VIOLATED) {
        result_set(result, VIOLATED, 1.0, label, english, &monitor->history);
        return true;
    }
    const double late_hidden = late(monitor->alarm, 300.5), worst = greatest(late_hidden, late(monitor->hidden, 300.5));
    const bool was_pending = monitor->verdict == PENDING;
    monitor->verdict = worst > 0.0 ? VIOLATED : monitor->alarm || monitor->hidden ? PENDING : HOLDING;
    if (worst > 0.0) history_fail(&monitor->history, &failures[late_hidden <= 0.0]);
    result_set(result, monitor->verdict, worst > 0.0 ? worst : -worst, label, english, &monitor->history);
    if (was_pending && monitor->verdict == PENDING) {
        result->limiting = monitor->alarm ? "due(alarm, hidden)" : "due(hidden, out)";
    }
    return true;
}
