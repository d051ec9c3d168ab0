// The generated monitor, with the names of the handwritten one.

#include "@SPEC@_monitor.h"

typedef @SPEC@_monitor Monitor;
typedef @SPEC@_signals Signals;
typedef @SPEC@_result Result;

#define monitor_begin(monitor) @SPEC@_init(monitor, NULL)
#define monitor_reset @SPEC@_reset
#define monitor_step @SPEC@_step
#define monitor_message @SPEC@_message
#define verdict_name @SPEC@_verdict_name
