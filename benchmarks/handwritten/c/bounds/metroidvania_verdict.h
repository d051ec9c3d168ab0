// The rules of examples/metroidvania.tltl, as Copilot and R2U2 keep them: counters, and nothing but the verdict.

#include "verdicts.h"

typedef struct {
    bool boss_door, double_jump, falls_pit1, falls_pit2, falls_pit3, damage, answers_g1, alarm, answers_g2, answers_g3;
} Signals;
typedef unsigned char Result;
typedef struct {
    uint16_t falls[3], damage, waiting[3];
    bool fell[3], begun[3], hurt, begun_hurt, upgraded, violated;
} Monitor;

enum { FALLS = 600, HURT = 60, ANSWER = 300 };

static inline void monitor_reset(Monitor *monitor) {
    *monitor = (Monitor){.falls = {FALLS + 1, FALLS + 1, FALLS + 1}, .damage = HURT + 1};
}

static inline bool monitor_step(Monitor *monitor, const Signals *sample, Result *result) {
    const bool falls[] = {sample->falls_pit1, sample->falls_pit2, sample->falls_pit3};
    const bool answers[] = {sample->answers_g1, sample->answers_g2, sample->answers_g3};
    bool violated = monitor->violated, due = false;
    monitor->upgraded |= sample->double_jump;
    violated |= sample->boss_door && !monitor->upgraded;
    for (int pit = 0; pit < 3; pit++) {
        monitor->falls[pit] = aged(monitor->falls[pit], monitor->begun[pit], FALLS + 1);
        monitor->begun[pit] = falls[pit] && !monitor->fell[pit];
        monitor->fell[pit] = falls[pit];
        violated |= monitor->begun[pit] && monitor->falls[pit] <= FALLS;
        due |= monitor->begun[pit];
    }
    monitor->damage = aged(monitor->damage, monitor->begun_hurt, HURT + 1);
    monitor->begun_hurt = sample->damage && !monitor->hurt;
    monitor->hurt = sample->damage;
    violated |= sample->damage && monitor->damage <= HURT;
    due |= monitor->begun_hurt;
    for (int guard = 0; guard < 3; guard++) {
        monitor->waiting[guard] = waited(monitor->waiting[guard], sample->alarm, answers[guard], ANSWER + 1);
        violated |= monitor->waiting[guard] > ANSWER;
        due |= monitor->waiting[guard] > 0;
    }
    monitor->violated = violated;
    *result = violated ? VIOLATED : due ? PENDING : HOLDING;
    return true;
}

static void print_result(const Result *result) {
    puts(verdict_names[*result]);
}
