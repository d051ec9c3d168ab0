// The rules of examples/metroidvania.tltl, with every field of a generated monitor.

#include "results.h"

typedef struct {
    bool boss_door, double_jump, falls_pit1, falls_pit2, falls_pit3, damage, answers_g1, alarm, answers_g2, answers_g3;
} Signals;
typedef struct {
    uint16_t falls[3], damage, waiting[3];
    bool fell[3], begun[3], hurt, begun_hurt, upgraded;
    Verdict verdict;
    History history;
} Monitor;

#define FALLS(pit) "(begins falls(" pit "))"
#define APART(pit) \
    "!breach(the next 10 s, begins falls(" pit "), !begins falls(" pit ")) & (" FALLS(pit) " -> X true) & "
#define DUE(guard) "due(alarm, answers(" guard "))"
#define ANSWER(guard) "!late(5 s, alarm, answers(" guard ")) & (" DUE(guard) " -> X true)"
#define BREACH(pit) "breach(the next 10 s, begins falls(" pit "), !begins falls(" pit "))"
#define LATE(guard) "late(5 s, alarm, answers(" guard "))"
#define GO_ON(when) "whenever " when ", the play must not end at that step; "
#define AVOID(event) \
    "whenever " event " begins, avoid the start of " event " for the next 10 s; " GO_ON(event " begins")
#define TWICE "keep all p in pits: begins falls(p) implies next always for 10 s not begins falls(p)"
#define ASLEEP "keep alarm implies all g in guards: eventually within 5 s answers(g)"
#define HURT "(begins damage)"

static inline void monitor_reset(Monitor *monitor) {
    *monitor = (Monitor){.falls = {1201, 1201, 1201}, .damage = 121, .verdict = HOLDING};
}

// What the trace fails at, after a step at which it does.
static const Failure *failure_of(const Monitor *monitor, const Signals *sample) {
    static const Failure failures[] = {
        {"keep boss_door implies once double_jump", "once double_jump"},
        {TWICE, BREACH("pit1")},
        {TWICE, BREACH("pit2")},
        {TWICE, BREACH("pit3")},
        {"keep begins damage implies next always for 1 s not damage", "breach(the next 1 s, begins damage, !damage)"},
        {ASLEEP, LATE("g1")},
        {ASLEEP, LATE("g2")},
        {ASLEEP, LATE("g3")},
    };
    if (sample->boss_door && !monitor->upgraded) return &failures[0];
    for (int pit = 0; pit < 3; pit++) {
        if (monitor->begun[pit] && recent(monitor->falls[pit], 600.5) > 0.0) return &failures[1 + pit];
    }
    if (sample->damage && recent(monitor->damage, 60.5) > 0.0) return &failures[4];
    const int guard = late(monitor->waiting[0], 300.5) > 0.0 ? 0 : late(monitor->waiting[1], 300.5) > 0.0 ? 1 : 2;
    return &failures[5 + guard];
}

static inline bool monitor_step(Monitor *monitor, const Signals *sample, Result *result) {
    static const char label[] =
        "G((boss_door -> once double_jump) & " APART("pit1") APART("pit2") APART("pit3")
        "!breach(the next 1 s, begins damage, !damage) & (" HURT " -> X true) & "
        ANSWER("g1") " & " ANSWER("g2") " & " ANSWER("g3") ")";
    static const char english[] =
        "Whenever boss_door, have double_jump now or before; " AVOID("falls(pit1)") AVOID("falls(pit2)")
        AVOID("falls(pit3)") "whenever damage begins, avoid damage for the next 1 s; " GO_ON("damage begins")
        "whenever alarm, reach answers(g1) within 5 s; whenever alarm, reach answers(g2) within 5 s; "
        "and whenever alarm, reach answers(g3) within 5 s.";
    static const char *const pits[] = {FALLS("pit1"), FALLS("pit2"), FALLS("pit3")};
    static const char *const guards[] = {DUE("g1"), DUE("g2"), DUE("g3")};
    const bool falls[] = {sample->falls_pit1, sample->falls_pit2, sample->falls_pit3};
    const bool answers[] = {sample->answers_g1, sample->answers_g2, sample->answers_g3};
    const char *due = NULL;
    double worst = -1.0;
    monitor->history.steps++;
    monitor->upgraded |= sample->double_jump;
    for (int pit = 0; pit < 3; pit++) {
        monitor->falls[pit] = aged(monitor->falls[pit], monitor->begun[pit], 1201);
        monitor->begun[pit] = falls[pit] && !monitor->fell[pit];
        monitor->fell[pit] = falls[pit];
        if (!monitor->begun[pit]) continue;
        worst = greatest(worst, recent(monitor->falls[pit], 600.5));
        if (!due) due = pits[pit];
    }
    monitor->damage = aged(monitor->damage, monitor->begun_hurt, 121);
    monitor->begun_hurt = sample->damage && !monitor->hurt;
    monitor->hurt = sample->damage;
    if (sample->damage) worst = greatest(worst, recent(monitor->damage, 60.5));
    if (monitor->begun_hurt && !due) due = HURT;
    for (int guard = 0; guard < 3; guard++) {
        monitor->waiting[guard] = waited(monitor->waiting[guard], sample->alarm, answers[guard], 601);
        worst = greatest(worst, late(monitor->waiting[guard], 300.5));
        if (monitor->waiting[guard] && !due) due = guards[guard];
    }
    if (sample->boss_door && !monitor->upgraded) worst = 1.0;

    if (monitor->verdict == VIOLATED) {
        result_set(result, VIOLATED, 1.0, label, english, &monitor->history);
        return true;
    }
    const bool was_pending = monitor->verdict == PENDING;
    monitor->verdict = worst > 0.0 ? VIOLATED : due ? PENDING : HOLDING;
    if (worst > 0.0) history_fail(&monitor->history, failure_of(monitor, sample));
    result_set(result, monitor->verdict, worst > 0.0 ? worst : -worst, label, english, &monitor->history);
    if (was_pending && monitor->verdict == PENDING) result->limiting = sample->boss_door ? "boss_door" : due;
    return true;
}
