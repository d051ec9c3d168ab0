// A generated monitor, with the names that a pass uses.

#include "@SPEC@_monitor.h"

typedef @SPEC@_monitor Monitor;
typedef @SPEC@_signals Signals;
typedef @SPEC@_result Result;

#define monitor_begin(monitor) @SPEC@_init(monitor, NULL)
#define monitor_reset @SPEC@_reset
#define monitor_step @SPEC@_step

static void print_result(const Result *result) {
#ifdef TLTL_VERDICT_ONLY
    printf("%s\t%d\n", @SPEC@_verdict_name(result->verdict), result->state);
#else
    printf("%s\t%d\t%d\t", @SPEC@_verdict_name(result->verdict), result->accepting, result->done);
    printf("%.17g\t%.17g\t%.17g\t", result->progress, result->reward, result->robustness);
    printf("%d\t%s\t%s\n", result->state, result->label, result->limiting ? result->limiting : "");
#endif
}
