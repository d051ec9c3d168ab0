// A handwritten monitor.

#include "@BY_HAND@/@SPEC@.h"

#define monitor_begin monitor_reset
