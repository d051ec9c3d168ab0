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
    printf("%d\t%s\t%s\t", result->state, result->label, result->limiting ? result->limiting : "");
    printf("%s\t%lld\t%s\t", result->label_english, result->failed_step, result->failed_clause ? result->failed_clause : "");
    printf("%s\n", result->failed_atom ? result->failed_atom : "");
#endif
}
