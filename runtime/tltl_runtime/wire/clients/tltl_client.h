// Connect a game in C or C++ to tltlc, and record the play of a person: copy this file into your game.
//
// C99 or C++11, with sockets of POSIX or Winsock, and nothing else.  One source file of the game, best one of its own,
// contains the code; in it, these two lines come before all others.  All other files only include the header:
//
//     #define TLTL_CLIENT_IMPLEMENTATION
//     #include "tltl_client.h"
//
// A game is a struct with its declaration and functions:
//
//     static int position, moves;
//
//     static tltl_outcome reset(void *self, tltl_client *client, const tltl_request *request) {  // begin an episode
//         if (request->scene && strcmp(request->scene, "crypt") == 0)
//             return tltl_refuse(client, "the scene `%s` cannot be loaded", request->scene);
//         position = moves = 0;
//         return TLTL_GOES_ON;
//     }
//
//     static tltl_outcome step(void *self, tltl_client *client, const tltl_request *request) {   // play one tick
//         long long action;
//         if (!tltl_whole(request->action, &action)) return tltl_refuse(client, "an action is a whole number");
//         position += (int)action - 1;
//         ++moves;
//         return position == 10 ? TLTL_ENDED : TLTL_GOES_ON;
//     }
//
//     static void describe(void *self, tltl_client *client) {                                    // the state now
//         double seen[1];
//         seen[0] = position;
//         tltl_signal(client, "position", position);
//         tltl_signal(client, "moves", moves);
//         tltl_signal_bool(client, "at_goal", position == 10);
//         tltl_observe(client, seen, 1);
//         tltl_position(client, "player", position, 0);
//     }
//
//     int main(void) {
//         static const tltl_signal_declaration signals[] = {
//             {"position", NULL, 0, 10}, {"moves", NULL, 0, INFINITY}, {"at_goal", "bool", 0, 1}};
//         static tltl_game game;  // static: what is not set is empty
//         game.hello.name = "counter";
//         game.hello.clock_hz = 10;
//         game.hello.signals = signals;
//         game.hello.signal_count = 3;
//         game.hello.actions = TLTL_DISCRETE(3);
//         game.hello.observation = TLTL_BOX(0, 10, "float32", 1);
//         game.hello.capabilities = TLTL_SEED | TLTL_POSITIONS;
//         game.reset = reset;
//         game.step = step;
//         game.describe = describe;
//         return tltl_play(&game);
//     }
//
// An engine with a main loop of its own, such as Unreal, calls this at the beginning of each tick.  The loop waits in
// it, so the game moves only when tltlc asks it to.  Let each tick have the same length, in Unreal with the options
// `-UseFixedTimeStep -FPS=60`.  Only the file with the code needs the sockets: keep it apart from the engine's headers.
//
//     void answer() {                                         // `client` is connected by tltl_connect
//         tltl_begin_state(&client);
//         tltl_signal(&client, "health", player->health);     // and so on
//         tltl_send_state(&client, has_ended);
//     }
//
//     void before_tick() {
//         if (ticks_left > 0 && --ticks_left > 0 && !has_ended) return;
//         if (is_asked) answer();                             // the ticks that were asked for have been played
//         is_asked = false;
//         while (!is_asked) {
//             if (!tltl_next_request(&client, &request) || request.kind == TLTL_CLOSE) { quit(client.error); return; }
//             if (request.kind == TLTL_STEP) is_asked = true;
//             else if (request.kind == TLTL_RESET) { load(request.scene, request.seed); answer(); }
//             else tltl_refuse(&client, "this game does not know the request `%s`", request.name);
//         }
//         ticks_left = request.repeat;
//         press(request.action);
//     }
//
// Functions that return int return 1, or 0 if something went wrong: then the field `error` says what, and is empty if
// tltlc has only closed the connection.  A client belongs to one thread.  `docs/wire.md` of tltlc describes the
// protocol.

#ifndef TLTL_CLIENT_H
#define TLTL_CLIENT_H

#if defined(TLTL_CLIENT_IMPLEMENTATION) && defined(_WIN32)
#ifndef _CRT_SECURE_NO_WARNINGS
#define _CRT_SECURE_NO_WARNINGS
#endif
#elif defined(TLTL_CLIENT_IMPLEMENTATION)
#ifndef _POSIX_C_SOURCE
#define _POSIX_C_SOURCE 200809L
#endif
#if defined(__APPLE__) && !defined(_DARWIN_C_SOURCE)
#define _DARWIN_C_SOURCE
#endif
#endif

#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#ifdef __GNUC__
#define TLTL_PRINTF_ __attribute__((format(printf, 2, 3)))
#else
#define TLTL_PRINTF_
#endif

// The most bytes of a request, and of a message that is sent.  Define them before the header to change them.
#ifndef TLTL_LONGEST_REQUEST
#define TLTL_LONGEST_REQUEST ((size_t)1 << 20)
#endif
#ifndef TLTL_LONGEST_MESSAGE
#define TLTL_LONGEST_MESSAGE ((size_t)1 << 25)
#endif

#ifdef __cplusplus
extern "C" {
#endif

enum { TLTL_PROTOCOL = 1, TLTL_DEEPEST = 64 };

// What a game declares --------------------------------------------------------------------------------------------

// Spaces, as JSON: TLTL_DISCRETE(4), TLTL_BOX(-1, 1, "float32", 84, 84, 3).  Others are written as docs/wire.md says:
// "{\"type\": \"multi_binary\", \"n\": 5}".
#define TLTL_DISCRETE(n) "{\"type\":\"discrete\",\"n\":" #n "}"
#define TLTL_BOX(low, high, dtype, ...)                                                                              \
    "{\"type\":\"box\",\"low\":" #low ",\"high\":" #high ",\"dtype\":\"" dtype "\",\"shape\":[" #__VA_ARGS__ "]}"

// A signal.  `type` is that of a signal in a spec, such as "bool"; NULL stands for "number".  The range is in SI units;
// an end that is infinite is no bound, and two ends that are 0 are none.
typedef struct {
    const char *name, *type;
    double low, high;
} tltl_signal_declaration;

typedef struct {
    const char *name;
    double value;
} tltl_param;

// Capabilities, to be added with |.
enum {
    TLTL_SEED = 1, TLTL_SNAPSHOTS = 2, TLTL_POSITIONS = 4, TLTL_SCREENSHOTS = 8, TLTL_OUTLINES = 16, TLTL_RELEASES = 32
};

// The declaration of a game.  All but `signals` and `actions` may be empty.
typedef struct {
    const char *name;
    double clock_hz;  // ticks in a second
    const tltl_signal_declaration *signals;
    size_t signal_count;
    const tltl_param *params;
    size_t param_count;
    const char *actions, *observation;  // spaces
    const char *const *scenes;          // the names of the scenes, the default one first
    size_t scene_count;
    int capabilities;
} tltl_hello;

// Requests --------------------------------------------------------------------------------------------------------

// A value of JSON.  `text` ends with a zero byte.  `count` is the number of values in a list, or of members in an
// object.  The values follow their list; `size` is the number of nodes of this value with all that are in it.
typedef enum { TLTL_NULL, TLTL_FALSE, TLTL_TRUE, TLTL_NUMBER, TLTL_TEXT, TLTL_LIST, TLTL_OBJECT } tltl_type;
typedef struct {
    tltl_type type;
    double number;
    const char *text;
    size_t count, size;
} tltl_node;

typedef enum {
    TLTL_RESET, TLTL_STEP, TLTL_SNAPSHOT, TLTL_RESTORE, TLTL_RELEASE, TLTL_SCREENSHOT, TLTL_OUTLINE, TLTL_CLOSE,
    TLTL_UNKNOWN
} tltl_kind;

// A request, valid until the next one is read.
typedef struct {
    tltl_kind kind;
    const char *name;         // of the kind, such as "step"
    const tltl_node *body;    // all that was sent
    const char *scene;        // NULL if none was sent
    const char *variant;      // "v0" if none was sent
    int has_seed;
    uint64_t seed;            // 0 if none was sent
    const tltl_node *action;  // NULL if none was sent
    int repeat;               // ticks to play, at least 1
    long long id;             // of the snapshot to restore or to release; -1 if it is no whole number
} tltl_request;

// Return a member of an object, or a value of a list; NULL if there is none, or `value` is NULL or something else.
const tltl_node *tltl_member(const tltl_node *value, const char *name);
const tltl_node *tltl_item(const tltl_node *value, size_t index);
// Set `result` to a number, or to a whole number within 2^53, and return 1; return 0 if `value` is something else.
int tltl_number(const tltl_node *value, double *result);
int tltl_whole(const tltl_node *value, long long *result);
// Write the numbers of a number, a list or nested lists, in order, but at most `capacity`; return how many there are.
size_t tltl_numbers(const tltl_node *value, double *results, size_t capacity);

// The connection --------------------------------------------------------------------------------------------------

typedef struct {
    char *data;
    size_t length, capacity;
} tltl_text_buffer;

// A connection to tltlc.  Read only `error`; the other fields are for the functions below.
typedef struct {
    char error[512];
    int has_failed, has_answered;
    intptr_t connection;
    tltl_text_buffer received, message, signals, observation, positions, cause, boxes, polygons, regions, frame;
    size_t used;
    tltl_node *nodes;
    size_t node_count, node_capacity;
} tltl_client;

// Connect to tltlc, and send the declaration.  `port` 0 and `token` NULL stand for the environment variables TLTL_PORT
// and TLTL_TOKEN.  Whether this succeeds or not, the client is to be closed at the end.
int tltl_connect(tltl_client *client, const tltl_hello *hello, int port, const char *token);
// Wait on a port of 127.0.0.1 until tltlc connects.  Use this if the game file has `connect = "127.0.0.1:PORT"`.  If
// the token is not empty, tltlc must send the same one.  While one tltlc plays, no other can connect.  Listen again
// after each connection:
//
//     tltl_hello hello = tltl_game_hello(&game);
//     while (tltl_listen(&client, &hello, 5000, NULL) && tltl_serve(&game, &client) == 0) {}
int tltl_listen(tltl_client *client, const tltl_hello *hello, int port, const char *token);
// Wait for the next request.  0 if tltlc has closed the connection, or refuses this game.
int tltl_next_request(tltl_client *client, tltl_request *request);
void tltl_close(tltl_client *client);

// Answer a `reset`, a `step` or a `restore`: begin, then give each declared signal, the observation, positions in
// metres (that of the player is "player") and, if the episode has ended, who or what ended it; then send.
void tltl_begin_state(tltl_client *client);
int tltl_signal(tltl_client *client, const char *name, double value);
int tltl_signal_bool(tltl_client *client, const char *name, int value);
int tltl_position(tltl_client *client, const char *name, double x, double y);
int tltl_position_3d(tltl_client *client, const char *name, double x, double y, double z);
int tltl_cause(tltl_client *client, const char *cause);
int tltl_send_state(tltl_client *client, int has_ended);

// The observation: a list of numbers; a large array as its bytes, little-endian, the last index changing fastest; or
// any other value as JSON.
int tltl_observe(tltl_client *client, const double *numbers, size_t count);
int tltl_observe_array(
    tltl_client *client, const void *data, size_t bytes, const char *dtype, const size_t *shape, size_t rank);
int tltl_observe_json(tltl_client *client, const char *json);

// Answer a `snapshot`, a `release`, a `screenshot` (3 or 4 bytes for each pixel, row by row), or that a request cannot be met.
int tltl_send_snapshot(tltl_client *client, long long id);
int tltl_send_release(tltl_client *client, long long id);
int tltl_send_picture(tltl_client *client, const void *pixels, size_t height, size_t width, size_t channels);
typedef enum { TLTL_REFUSED, TLTL_GOES_ON, TLTL_ENDED } tltl_outcome;
tltl_outcome tltl_refuse(tltl_client *client, const char *format, ...) TLTL_PRINTF_;

// Answer an `outline`: begin, then give what maps of the current scene and variant show, in metres; then send.  x points
// east and y north.  A box has two opposite corners, each with `dimensions` coordinates, 2 or 3: four or six numbers.
// tltl_boxes gives all boxes with one name, of things that stop players; a polygon is an area, with two numbers for each
// corner; reasons name regions.  The image, of 3 or 4 bytes for each pixel, has its north at the top.
void tltl_begin_outline(tltl_client *client);
int tltl_bounds(tltl_client *client, const double *box, size_t dimensions);
int tltl_boxes(tltl_client *client, const char *name, const double *boxes, size_t count, size_t dimensions);
int tltl_polygon(tltl_client *client, const char *name, const double *corners, size_t count);
int tltl_region(tltl_client *client, const char *name, const double *box, size_t dimensions);
int tltl_image(
    tltl_client *client, const void *pixels, size_t height, size_t width, size_t channels,
    const double west_south_east_north[4]);
int tltl_send_outline(tltl_client *client);

// A game, and a loop that plays it --------------------------------------------------------------------------------

// `reset`, `step` (one tick) and `restore` return whether the episode has ended now, or the result of tltl_refuse.
// `describe` gives the state: what is between tltl_begin_state and tltl_send_state.  Optional: `snapshot` keeps the
// state of the game and returns an id of at least 0, or -1 if it cannot; `release` forgets the snapshot with this id,
// because there will be no return to it, and returns 1, or 0 if there is none; `screenshot` calls tltl_send_picture;
// `outline` gives what is between tltl_begin_outline and tltl_send_outline; `close` is called at the end.  `describe`,
// `screenshot` and `outline` may call tltl_refuse instead; nothing else is sent then.  `self` is passed to each function.
typedef struct {
    tltl_hello hello;
    void *self;
    tltl_outcome (*reset)(void *self, tltl_client *client, const tltl_request *request);
    tltl_outcome (*step)(void *self, tltl_client *client, const tltl_request *request);
    void (*describe)(void *self, tltl_client *client);
    long long (*snapshot)(void *self);
    tltl_outcome (*restore)(void *self, tltl_client *client, const tltl_request *request);
    int (*release)(void *self, long long id);
    int (*screenshot)(void *self, tltl_client *client);
    void (*outline)(void *self, tltl_client *client);
    void (*close)(void *self);
} tltl_game;

// Return the declaration of a game, with the capabilities for snapshots, their release, screenshots and outlines if it
// has the functions.
tltl_hello tltl_game_hello(const tltl_game *game);
// Answer requests until tltlc closes the connection, and close the client.  Return the exit status of the process; if
// it is 1, the reason is on standard error.
int tltl_serve(const tltl_game *game, tltl_client *client);
// Connect to tltlc, and serve.
int tltl_play(const tltl_game *game);

// The recorder ----------------------------------------------------------------------------------------------------

// Writes the play of a person as traces, which `tltlc monitor` can judge later; needs no connection.  Each episode is a
// file in `folder`: trace-0001.csv, trace-0002.csv and so on; no file is overwritten.  With `clock_hz`, the number of
// samples in a second, the files have a column `time`; with 0, they have none:
//
//     tltl_recorder recorder;
//     tltl_recorder_init(&recorder, "traces", signals, 3, 10);
//     tltl_recorder_begin(&recorder);
//     double values[3] = {1, 1, 0};                 // of all signals, in order
//     tltl_recorder_sample(&recorder, values);      // after each tick
//     tltl_recorder_end(&recorder);
//
// With the actions of the person, as tltlc would send them, each episode is also a tape, trace-0001.tape.jsonl, with
// which the play can be repeated.  `recorder.game` is the name of the game, by default "game":
//
//     tltl_recorder_begin_scene(&recorder, "short", "v0", 7);
//     tltl_recorder_step(&recorder, "2", values);
typedef struct {
    char error[512];
    char folder[1024], path[1056];  // of the trace that is written
    const tltl_signal_declaration *signals;
    size_t signal_count;
    double clock_hz;
    unsigned long samples;
    FILE *file, *tape;
    int has_begun;
    const char *game, *scene, *variant;
    long long seed;
    uint32_t digest[2];
} tltl_recorder;

int tltl_recorder_init(
    tltl_recorder *recorder, const char *folder, const tltl_signal_declaration *signals, size_t signal_count,
    double clock_hz);
// Begin a new trace, and end the one before; the first sample makes its file, which will be `recorder->path`.
int tltl_recorder_begin(tltl_recorder *recorder);
// The same, and a tape says which scene, variant and seed are played: NULL and -1 if there are none.  The texts must
// stay where they are until the episode ends.
int tltl_recorder_begin_scene(tltl_recorder *recorder, const char *scene, const char *variant, long long seed);
// Write the values of all signals at one moment to the file at once; begin a trace if there is none.
int tltl_recorder_sample(tltl_recorder *recorder, const double *values);
// The same, and write the step to the tape.  `action` is what the person did in the tick before, as JSON without line
// ends, such as "2" or "[1, 0]".  All samples of an episode have an action, or none has.
int tltl_recorder_step(tltl_recorder *recorder, const char *action, const double *values);
// End the trace and its tape, if there is one.
int tltl_recorder_end(tltl_recorder *recorder);

#ifdef __cplusplus
}
#endif

#endif  // TLTL_CLIENT_H

#if defined(TLTL_CLIENT_IMPLEMENTATION) && !defined(TLTL_CLIENT_IMPLEMENTED)
#define TLTL_CLIENT_IMPLEMENTED

#include <errno.h>
#include <float.h>
#include <limits.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#ifdef _WIN32
#include <winsock2.h>
#include <direct.h>
#include <fcntl.h>
#include <io.h>
#include <sys/stat.h>
#ifdef _MSC_VER
#pragma comment(lib, "ws2_32.lib")
#endif
typedef SOCKET tltl_socket_;
#else
#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>
typedef int tltl_socket_;
#endif

#ifdef __cplusplus
extern "C" {
#endif

enum { TLTL_CHUNK_ = 65536, TLTL_LONGEST_FIRST_LINE_ = 65536, TLTL_NUMBER_SIZE_ = 64, TLTL_LONGEST_NUMBER_ = 512 };

// Errors and buffers ----------------------------------------------------------------------------------------------

// Cut a text that was too long for its buffer, so that it does not end within a character of UTF-8.
static void tltl_cut_(char *text) {
    size_t length = strlen(text), start = length, needed = 1;
    unsigned char first;
    while (start > 0 && length - start < 3 && ((unsigned char)text[start - 1] & 0xC0u) == 0x80u) --start;
    if (start == 0) return;
    first = (unsigned char)text[start - 1];
    if (first >= 0xF0u) needed = 4;
    else if (first >= 0xE0u) needed = 3;
    else if (first >= 0xC0u) needed = 2;
    if (length - (start - 1) < needed) text[start - 1] = '\0';
}

static int tltl_fail_(tltl_client *client, const char *format, ...) TLTL_PRINTF_;
static int tltl_fail_(tltl_client *client, const char *format, ...) {
    va_list values;
    if (client->has_failed) return 0;  // The first reason counts.
    client->has_failed = 1;
    va_start(values, format);
    vsnprintf(client->error, sizeof client->error, format, values);
    va_end(values);
    tltl_cut_(client->error);
    return 0;
}

static int tltl_reserve_(tltl_client *client, tltl_text_buffer *buffer, size_t more) {
    size_t capacity = buffer->capacity ? buffer->capacity : 256, needed;
    char *data;
    if (more > TLTL_LONGEST_MESSAGE || buffer->length > TLTL_LONGEST_MESSAGE - more)
        return tltl_fail_(client, "the message is longer than %lu bytes", (unsigned long)TLTL_LONGEST_MESSAGE);
    needed = buffer->length + more;
    if (needed <= buffer->capacity) return 1;
    while (capacity < needed) capacity *= 2;
    data = (char *)realloc(buffer->data, capacity);
    if (!data) return tltl_fail_(client, "there is no memory for a message of %lu bytes", (unsigned long)needed);
    buffer->data = data;
    buffer->capacity = capacity;
    return 1;
}

static int tltl_add_bytes_(tltl_client *client, tltl_text_buffer *buffer, const char *data, size_t length) {
    if (!tltl_reserve_(client, buffer, length)) return 0;
    if (length) memcpy(buffer->data + buffer->length, data, length);
    buffer->length += length;
    return 1;
}

static int tltl_add_(tltl_client *client, tltl_text_buffer *buffer, const char *text) {
    return tltl_add_bytes_(client, buffer, text, strlen(text));
}

static int tltl_add_buffer_(tltl_client *client, tltl_text_buffer *buffer, const tltl_text_buffer *other) {
    return tltl_add_bytes_(client, buffer, other->data, other->length);
}

static int tltl_is_finite_(double value) { return value >= -DBL_MAX && value <= DBL_MAX; }

static const char *tltl_odd_number_(double value) { return value > 0 ? "inf" : value < 0 ? "-inf" : "nan"; }

// Write the shortest text of a finite number that has its value, whatever the locale is.
static void tltl_number_text_(double value, char text[TLTL_NUMBER_SIZE_]) {
    char *from = text, *to = text;
    int digits;
    if (value > -9007199254740992.0 && value < 9007199254740992.0 && (double)(long long)value == value) {
        if (value == 0 && 1 / value < 0) snprintf(text, TLTL_NUMBER_SIZE_, "-0.0");
        else snprintf(text, TLTL_NUMBER_SIZE_, "%lld", (long long)value);
        return;
    }
    for (digits = 15; digits <= 17; ++digits) {
        snprintf(text, TLTL_NUMBER_SIZE_, "%.*g", digits, value);
        if (strtod(text, NULL) == value) break;
    }
    while (*from) {
        if ((*from >= '0' && *from <= '9') || *from == '-' || *from == '+' || *from == 'e') {
            *to++ = *from++;
        } else {
            while (*from && strchr("0123456789+-e", *from) == NULL) ++from;
            *to++ = '.';
        }
    }
    *to = '\0';
}

static int tltl_add_number_(tltl_client *client, tltl_text_buffer *buffer, double value) {
    char text[TLTL_NUMBER_SIZE_];
    if (!tltl_is_finite_(value))
        return tltl_fail_(
            client, "the number %s cannot be sent: numbers must be finite", tltl_odd_number_(value));
    tltl_number_text_(value, text);
    return tltl_add_(client, buffer, text);
}

static int tltl_add_quoted_(tltl_client *client, tltl_text_buffer *buffer, const char *text) {
    if (!tltl_add_(client, buffer, "\"")) return 0;
    while (*text) {
        size_t plain = 0;
        char escape[8];
        while ((unsigned char)text[plain] >= 0x20u && text[plain] != '"' && text[plain] != '\\') ++plain;
        if (!tltl_add_bytes_(client, buffer, text, plain)) return 0;
        text += plain;
        if (!*text) break;
        snprintf(escape, sizeof escape, "\\u%04x", (unsigned)(unsigned char)*text++);
        if (!tltl_add_(client, buffer, escape)) return 0;
    }
    return tltl_add_(client, buffer, "\"");
}

// Add `"name":` to an object whose members are in `buffer`.
static int tltl_add_key_(tltl_client *client, tltl_text_buffer *buffer, const char *name) {
    return (buffer->length == 0 || tltl_add_(client, buffer, ",")) && tltl_add_quoted_(client, buffer, name)
           && tltl_add_(client, buffer, ":");
}

static int tltl_add_base64_(tltl_client *client, tltl_text_buffer *buffer, const unsigned char *data, size_t bytes) {
    static const char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    size_t index;
    char *to;
    if (bytes > TLTL_LONGEST_MESSAGE / 4 * 3)
        return tltl_fail_(client, "an array of %lu bytes is too large to be sent", (unsigned long)bytes);
    if (!tltl_reserve_(client, buffer, (bytes + 2) / 3 * 4)) return 0;
    to = buffer->data + buffer->length;
    for (index = 0; index < bytes; index += 3) {
        size_t left = bytes - index;
        unsigned long number = (unsigned long)data[index] << 16;
        if (left > 1) number |= (unsigned long)data[index + 1] << 8;
        if (left > 2) number |= (unsigned long)data[index + 2];
        *to++ = letters[number >> 18 & 63u];
        *to++ = letters[number >> 12 & 63u];
        *to++ = left > 1 ? letters[number >> 6 & 63u] : '=';
        *to++ = left > 2 ? letters[number & 63u] : '=';
    }
    buffer->length += (bytes + 2) / 3 * 4;
    return 1;
}

static int tltl_add_array_(
    tltl_client *client, tltl_text_buffer *buffer, const void *data, size_t bytes, const char *dtype,
    const size_t *shape, size_t rank) {
    size_t index;
    if (!tltl_add_(client, buffer, "{\"base64\":\"")
        || !tltl_add_base64_(client, buffer, (const unsigned char *)data, bytes)
        || !tltl_add_(client, buffer, "\",\"dtype\":") || !tltl_add_quoted_(client, buffer, dtype)
        || !tltl_add_(client, buffer, ",\"shape\":["))
        return 0;
    for (index = 0; index < rank; ++index) {
        if (index && !tltl_add_(client, buffer, ",")) return 0;
        if (!tltl_add_number_(client, buffer, (double)shape[index])) return 0;
    }
    return tltl_add_(client, buffer, "]}");
}

// JSON, read ------------------------------------------------------------------------------------------------------

// Reads the bytes from `at` to `end`; texts are decoded in place.
typedef struct {
    tltl_client *client;
    char *at, *end;
} tltl_reader_;

static int tltl_read_value_(tltl_reader_ *reader, int depth);

static int tltl_wrong_(tltl_reader_ *reader) {
    return tltl_fail_(reader->client, "tltlc sent a line that is not JSON");
}

static void tltl_skip_blanks_(tltl_reader_ *reader) {
    while (reader->at < reader->end
           && (*reader->at == ' ' || *reader->at == '\t' || *reader->at == '\r' || *reader->at == '\n'))
        ++reader->at;
}

// Whether the next byte is `mark`; then pass it.
static int tltl_passes_(tltl_reader_ *reader, char mark) {
    if (reader->at >= reader->end || *reader->at != mark) return 0;
    ++reader->at;
    return 1;
}

// Add a node and set `index` to its place; the nodes may move, so that pointers to them are not kept.
static int tltl_add_node_(tltl_client *client, tltl_type type, size_t *index) {
    tltl_node *node;
    if (client->node_count == client->node_capacity) {
        size_t capacity = client->node_capacity ? client->node_capacity * 2 : 64;
        tltl_node *nodes = NULL;
        if (capacity <= SIZE_MAX / sizeof *nodes)
            nodes = (tltl_node *)realloc(client->nodes, capacity * sizeof *nodes);
        if (!nodes) return tltl_fail_(client, "there is no memory for a request of tltlc");
        client->nodes = nodes;
        client->node_capacity = capacity;
    }
    *index = client->node_count++;
    node = &client->nodes[*index];
    memset(node, 0, sizeof *node);
    node->type = type;
    node->size = 1;
    return 1;
}

// Return the number of the four hexadecimal digits at `at`; -1 if they are none.
static long tltl_hex_(const char *at, const char *end) {
    long number = 0;
    int index;
    if (end - at < 4) return -1;
    for (index = 0; index < 4; ++index) {
        char digit = at[index];
        number *= 16;
        if (digit >= '0' && digit <= '9') number += digit - '0';
        else if (digit >= 'a' && digit <= 'f') number += digit - 'a' + 10;
        else if (digit >= 'A' && digit <= 'F') number += digit - 'A' + 10;
        else return -1;
    }
    return number;
}

static char *tltl_put_utf8_(char *to, long code) {
    if (code < 0x80) {
        *to++ = (char)code;
        return to;
    }
    if (code < 0x800) {
        *to++ = (char)(0xC0 | code >> 6);
    } else {
        if (code < 0x10000) {
            *to++ = (char)(0xE0 | code >> 12);
        } else {
            *to++ = (char)(0xF0 | code >> 18);
            *to++ = (char)(0x80 | (code >> 12 & 0x3F));
        }
        *to++ = (char)(0x80 | (code >> 6 & 0x3F));
    }
    *to++ = (char)(0x80 | (code & 0x3F));
    return to;
}

// Read an escape, whose backslash is passed already, and write its character to `to`, never more bytes than were read.
static int tltl_read_escape_(tltl_reader_ *reader, char **to) {
    static const char letters[] = "\"\\/bfnrt", meanings[] = "\"\\/\b\f\n\r\t";
    const char *found;
    long code, low;
    if (reader->at >= reader->end) return tltl_wrong_(reader);
    if (*reader->at != 'u') {
        found = *reader->at ? strchr(letters, *reader->at) : NULL;
        if (!found) return tltl_wrong_(reader);
        *(*to)++ = meanings[found - letters];
        ++reader->at;
        return 1;
    }
    code = tltl_hex_(reader->at + 1, reader->end);
    if (code < 0) return tltl_wrong_(reader);
    reader->at += 5;
    if (code >= 0xD800 && code < 0xDC00 && reader->end - reader->at >= 6 && reader->at[0] == '\\'
        && reader->at[1] == 'u') {
        low = tltl_hex_(reader->at + 2, reader->end);
        if (low >= 0xDC00 && low < 0xE000) {
            code = 0x10000 + ((code - 0xD800) << 10) + (low - 0xDC00);
            reader->at += 6;
        }
    }
    // A zero byte would end the text, and half a pair is no character: both become the replacement character.
    if (code == 0 || (code >= 0xD800 && code < 0xE000)) code = 0xFFFD;
    *to = tltl_put_utf8_(*to, code);
    return 1;
}

// Return the number of bytes of the character at `at`, which is not ASCII; 0 if it is not UTF-8.
static int tltl_utf8_length_(const char *at, const char *end) {
    unsigned char first = (unsigned char)at[0], second;
    int length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2, index;
    if (first < 0xC2 || first > 0xF4 || end - at < length) return 0;
    for (index = 1; index < length; ++index)
        if (((unsigned char)at[index] & 0xC0u) != 0x80u) return 0;
    second = (unsigned char)at[1];
    if ((first == 0xE0 && second < 0xA0) || (first == 0xED && second > 0x9F) || (first == 0xF0 && second < 0x90)
        || (first == 0xF4 && second > 0x8F))
        return 0;
    return length;
}

// Read a text, whose first quote is passed already.
static int tltl_read_text_(tltl_reader_ *reader, const char **text) {
    char *to = reader->at;
    *text = to;
    while (reader->at < reader->end) {
        unsigned char letter = (unsigned char)*reader->at;
        int length = 1;
        if (letter == '"') {
            *to = '\0';  // At the latest, this replaces the quote.
            ++reader->at;
            return 1;
        }
        if (letter < 0x20) return tltl_wrong_(reader);
        if (letter == '\\') {
            ++reader->at;
            if (!tltl_read_escape_(reader, &to)) return 0;
            continue;
        }
        if (letter >= 0x80) {
            length = tltl_utf8_length_(reader->at, reader->end);
            if (!length) return tltl_wrong_(reader);
        }
        while (length-- > 0) *to++ = *reader->at++;
    }
    return tltl_wrong_(reader);
}

static size_t tltl_pass_digits_(tltl_reader_ *reader) {
    char *start = reader->at;
    while (reader->at < reader->end && *reader->at >= '0' && *reader->at <= '9') ++reader->at;
    return (size_t)(reader->at - start);
}

// Return the value of the text of a number, with a point, also where the locale has a comma.
static int tltl_number_of_(tltl_reader_ *reader, const char *start, size_t length, double *value) {
    char copy[TLTL_LONGEST_NUMBER_ + 16], half[16];
    size_t index, to = 0, point_length;
    snprintf(half, sizeof half, "%.1f", 0.5);
    point_length = strlen(half) - 2;
    if (length > TLTL_LONGEST_NUMBER_) return tltl_fail_(reader->client, "tltlc sent a number that is too long");
    for (index = 0; index < length; ++index) {
        if (start[index] == '.') {
            memcpy(copy + to, half + 1, point_length);
            to += point_length;
        } else {
            copy[to++] = start[index];
        }
    }
    copy[to] = '\0';
    *value = strtod(copy, NULL);
    return tltl_is_finite_(*value) || tltl_fail_(reader->client, "tltlc sent a number that is not finite");
}

static int tltl_read_number_(tltl_reader_ *reader) {
    char *start = reader->at, *digits;
    size_t index, whole;
    double value;
    tltl_passes_(reader, '-');
    digits = reader->at;
    whole = tltl_pass_digits_(reader);
    if (whole == 0 || (whole > 1 && *digits == '0')) return tltl_wrong_(reader);
    if (tltl_passes_(reader, '.') && tltl_pass_digits_(reader) == 0) return tltl_wrong_(reader);
    if (tltl_passes_(reader, 'e') || tltl_passes_(reader, 'E')) {
        if (!tltl_passes_(reader, '-')) tltl_passes_(reader, '+');
        if (tltl_pass_digits_(reader) == 0) return tltl_wrong_(reader);
    }
    return tltl_number_of_(reader, start, (size_t)(reader->at - start), &value)
           && tltl_add_node_(reader->client, TLTL_NUMBER, &index)
           && ((reader->client->nodes[index].number = value), 1);
}

static int tltl_read_word_(tltl_reader_ *reader, const char *word, tltl_type type) {
    size_t length = strlen(word), index;
    if ((size_t)(reader->end - reader->at) < length || memcmp(reader->at, word, length) != 0)
        return tltl_wrong_(reader);
    reader->at += length;
    return tltl_add_node_(reader->client, type, &index);
}

static int tltl_read_text_node_(tltl_reader_ *reader) {
    size_t index;
    const char *text;
    if (!tltl_passes_(reader, '"') || !tltl_read_text_(reader, &text)) return tltl_wrong_(reader);
    if (!tltl_add_node_(reader->client, TLTL_TEXT, &index)) return 0;
    reader->client->nodes[index].text = text;
    return 1;
}

// Read a list or an object, whose first bracket is passed already.
static int tltl_read_many_(tltl_reader_ *reader, int is_object, int depth) {
    char last = is_object ? '}' : ']';
    size_t index, count = 0;
    if (depth >= TLTL_DEEPEST) return tltl_fail_(reader->client, "tltlc sent a line that nests too deep");
    if (!tltl_add_node_(reader->client, is_object ? TLTL_OBJECT : TLTL_LIST, &index)) return 0;
    tltl_skip_blanks_(reader);
    if (!tltl_passes_(reader, last)) {
        do {
            tltl_skip_blanks_(reader);
            if (is_object) {
                if (!tltl_read_text_node_(reader)) return 0;
                tltl_skip_blanks_(reader);
                if (!tltl_passes_(reader, ':')) return tltl_wrong_(reader);
            }
            if (!tltl_read_value_(reader, depth + 1)) return 0;
            ++count;
            tltl_skip_blanks_(reader);
        } while (tltl_passes_(reader, ','));
        if (!tltl_passes_(reader, last)) return tltl_wrong_(reader);
    }
    reader->client->nodes[index].count = count;
    reader->client->nodes[index].size = reader->client->node_count - index;
    return 1;
}

static int tltl_read_value_(tltl_reader_ *reader, int depth) {
    tltl_skip_blanks_(reader);
    if (tltl_passes_(reader, '{')) return tltl_read_many_(reader, 1, depth);
    if (tltl_passes_(reader, '[')) return tltl_read_many_(reader, 0, depth);
    if (reader->at >= reader->end) return tltl_wrong_(reader);
    switch (*reader->at) {
        case '"': return tltl_read_text_node_(reader);
        case 't': return tltl_read_word_(reader, "true", TLTL_TRUE);
        case 'f': return tltl_read_word_(reader, "false", TLTL_FALSE);
        case 'n': return tltl_read_word_(reader, "null", TLTL_NULL);
        default: return tltl_read_number_(reader);
    }
}

// Read the value of a line into the nodes of the client.
static int tltl_read_json_(tltl_client *client, char *line, size_t length) {
    tltl_reader_ reader;
    reader.client = client;
    reader.at = line;
    reader.end = line + length;
    client->node_count = 0;
    if (!tltl_read_value_(&reader, 0)) return 0;
    tltl_skip_blanks_(&reader);
    return reader.at == reader.end || tltl_wrong_(&reader);
}

const tltl_node *tltl_member(const tltl_node *value, const char *name) {
    const tltl_node *key;
    size_t index;
    if (!value || value->type != TLTL_OBJECT) return NULL;
    key = value + 1;
    for (index = 0; index < value->count; ++index) {
        if (strcmp(key->text, name) == 0) return key + 1;
        key += 1 + key[1].size;
    }
    return NULL;
}

const tltl_node *tltl_item(const tltl_node *value, size_t index) {
    const tltl_node *item;
    if (!value || value->type != TLTL_LIST || index >= value->count) return NULL;
    for (item = value + 1; index > 0; --index) item += item->size;
    return item;
}

int tltl_number(const tltl_node *value, double *result) {
    if (!value || value->type != TLTL_NUMBER) return 0;
    *result = value->number;
    return 1;
}

int tltl_whole(const tltl_node *value, long long *result) {
    double number;
    if (!tltl_number(value, &number) || number < -9007199254740992.0 || number > 9007199254740992.0) return 0;
    if ((double)(long long)number != number) return 0;
    *result = (long long)number;
    return 1;
}

size_t tltl_numbers(const tltl_node *value, double *results, size_t capacity) {
    size_t index, count = 0;
    if (!value) return 0;
    // The values of nested lists follow each other.  An object, which holds texts and numbers, is passed over.
    for (index = 0; index < value->size; index += value[index].type == TLTL_OBJECT ? value[index].size : 1) {
        if (value[index].type != TLTL_NUMBER) continue;
        if (count < capacity) results[count] = value[index].number;
        ++count;
    }
    return count;
}

// Sockets ---------------------------------------------------------------------------------------------------------

static const char *tltl_socket_error_(void) {
#ifdef _WIN32
    static char text[32];
    snprintf(text, sizeof text, "error %d", WSAGetLastError());
    return text;
#else
    return strerror(errno);
#endif
}

static int tltl_was_interrupted_(void) {
#ifdef _WIN32
    return 0;
#else
    return errno == EINTR;
#endif
}

static void tltl_close_socket_(intptr_t connection) {
    if (connection < 0) return;
#ifdef _WIN32
    closesocket((SOCKET)connection);
#else
    close((int)connection);
#endif
}

static intptr_t tltl_new_socket_(void) {
#ifdef _WIN32
    WSADATA data;
    SOCKET made;
    if (WSAStartup(MAKEWORD(2, 2), &data) != 0) return -1;
    made = socket(AF_INET, SOCK_STREAM, IPPROTO_TCP);
    return made == INVALID_SOCKET ? -1 : (intptr_t)made;
#else
    return socket(AF_INET, SOCK_STREAM, 0);
#endif
}

static struct sockaddr_in tltl_address_(int port) {
    struct sockaddr_in address;
    memset(&address, 0, sizeof address);
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons((unsigned short)port);
    return address;
}

static void tltl_set_options_(intptr_t connection) {
    int on = 1;
    setsockopt((tltl_socket_)connection, IPPROTO_TCP, TCP_NODELAY, (const char *)&on, sizeof on);
#ifdef SO_NOSIGPIPE
    setsockopt((tltl_socket_)connection, SOL_SOCKET, SO_NOSIGPIPE, (const char *)&on, sizeof on);
#endif
}

// Send all bytes; return 0 if the connection is closed.
static int tltl_send_bytes_(intptr_t connection, const char *data, size_t length) {
#ifdef MSG_NOSIGNAL
    const int flags = MSG_NOSIGNAL;
#else
    const int flags = 0;
#endif
    while (length > 0) {
        const int piece = length > INT_MAX ? INT_MAX : (int)length;
        const long sent = (long)send((tltl_socket_)connection, data, (size_t)piece, flags);
        if (sent < 0 && tltl_was_interrupted_()) continue;
        if (sent <= 0) return 0;
        data += sent;
        length -= (size_t)sent;
    }
    return 1;
}

// Read the next line into the client's buffer; 0 if the connection ends, or on any other error, which is noted.
static int tltl_read_line_(tltl_client *client, size_t longest, size_t *length) {
    tltl_text_buffer *buffer = &client->received;
    size_t searched = 0;
    if (client->used) {
        memmove(buffer->data, buffer->data + client->used, buffer->length - client->used);
        buffer->length -= client->used;
        client->used = 0;
    }
    for (;;) {
        long count;
        const char *end = NULL;
        if (buffer->length > searched)
            end = (const char *)memchr(buffer->data + searched, '\n', buffer->length - searched);
        *length = end ? (size_t)(end - buffer->data) : buffer->length;
        if (*length > longest)
            return tltl_fail_(client, "tltlc sent a line of more than %lu bytes", (unsigned long)longest);
        if (end) {
            client->used = *length + 1;
            return 1;
        }
        searched = buffer->length;
        if (!tltl_reserve_(client, buffer, TLTL_CHUNK_)) return 0;
        do {
            count = (long)recv((tltl_socket_)client->connection, buffer->data + buffer->length, TLTL_CHUNK_, 0);
        } while (count < 0 && tltl_was_interrupted_());
        if (count <= 0) {
            client->has_failed = 1;  // Without a reason: tltlc has ended.
            return 0;
        }
        buffer->length += (size_t)count;
    }
}

// Messages --------------------------------------------------------------------------------------------------------

static void tltl_init_(tltl_client *client) {
    memset(client, 0, sizeof *client);
    client->connection = -1;
}

// Set `client->error` to the message of an `error` that tltlc sent.
static int tltl_note_refusal_(tltl_client *client, const tltl_node *error) {
    const tltl_node *message = tltl_member(error, "message");
    if (!message) message = error;
    return tltl_fail_(client, "%s", message->type == TLTL_TEXT ? message->text : "tltlc refuses this game");
}

// Send the line in `client->message`.  If that fails, note why tltlc closed the connection, if it said so.
static int tltl_send_message_(tltl_client *client) {
    size_t length;
    if (client->has_failed || !tltl_add_(client, &client->message, "\n")) return 0;
    client->has_answered = 1;
    if (tltl_send_bytes_(client->connection, client->message.data, client->message.length)) return 1;
    if (tltl_read_line_(client, TLTL_LONGEST_REQUEST, &length)
        && tltl_read_json_(client, client->received.data, length)) {
        const tltl_node *error = tltl_member(client->nodes, "error");
        if (error) return tltl_note_refusal_(client, error);
    }
    client->has_failed = 1;
    return 0;
}

static int tltl_begin_message_(tltl_client *client, const char *start) {
    client->message.length = 0;
    return !client->has_failed && tltl_add_(client, &client->message, start);
}

static int tltl_add_end_(tltl_client *client, tltl_text_buffer *text, double end) {
    return tltl_is_finite_(end) ? tltl_add_number_(client, text, end) : tltl_add_(client, text, "null");
}

static int tltl_is_bool_(const tltl_signal_declaration *signal) {
    return signal->type && strcmp(signal->type, "bool") == 0;
}

static int tltl_add_signal_(tltl_client *client, tltl_text_buffer *text, const tltl_signal_declaration *signal) {
    const int has_range = !tltl_is_bool_(signal) && (signal->low != 0 || signal->high != 0);
    if (!tltl_add_quoted_(client, text, signal->name) || !tltl_add_(client, text, ":{")) return 0;
    if (signal->type && !(tltl_add_(client, text, "\"type\":") && tltl_add_quoted_(client, text, signal->type)))
        return 0;
    if (has_range
        && !(tltl_add_(client, text, signal->type ? ",\"range\":[" : "\"range\":[")
             && tltl_add_end_(client, text, signal->low) && tltl_add_(client, text, ",")
             && tltl_add_end_(client, text, signal->high) && tltl_add_(client, text, "]")))
        return 0;
    return tltl_add_(client, text, "}");
}

static int tltl_add_signals_(tltl_client *client, const tltl_hello *hello) {
    size_t index;
    for (index = 0; index < hello->signal_count; ++index)
        if ((index && !tltl_add_(client, &client->message, ","))
            || !tltl_add_signal_(client, &client->message, &hello->signals[index]))
            return 0;
    return 1;
}

// Add `json`, which the game has written, in one line; the line ends of JSON are blanks.
static int tltl_add_json_(tltl_client *client, tltl_text_buffer *buffer, const char *json) {
    size_t from = buffer->length, index;
    if (!tltl_add_(client, buffer, json)) return 0;
    for (index = from; index < buffer->length; ++index)
        if (buffer->data[index] == '\n' || buffer->data[index] == '\r') buffer->data[index] = ' ';
    return 1;
}

static int tltl_add_member_(tltl_client *client, const char *key, const char *json) {
    return !json || (tltl_add_(client, &client->message, key) && tltl_add_json_(client, &client->message, json));
}

static int tltl_add_words_(tltl_client *client, const char *const *words, size_t count) {
    size_t index;
    for (index = 0; index < count; ++index)
        if ((index && !tltl_add_(client, &client->message, ","))
            || !tltl_add_quoted_(client, &client->message, words[index]))
            return 0;
    return 1;
}

static int tltl_add_capabilities_(tltl_client *client, int capabilities) {
    const char *words[6];
    size_t count = 0;
    if (capabilities & TLTL_SEED) words[count++] = "seed";
    if (capabilities & TLTL_SNAPSHOTS) words[count++] = "snapshot";
    if (capabilities & TLTL_RELEASES) words[count++] = "release";
    if (capabilities & TLTL_POSITIONS) words[count++] = "positions";
    if (capabilities & TLTL_SCREENSHOTS) words[count++] = "screenshot";
    if (capabilities & TLTL_OUTLINES) words[count++] = "outline";
    return tltl_add_words_(client, words, count);
}

static int tltl_add_params_(tltl_client *client, const tltl_hello *hello) {
    tltl_text_buffer *text = &client->message;
    size_t index;
    for (index = 0; index < hello->param_count; ++index)
        if ((index && !tltl_add_(client, text, ",")) || !tltl_add_quoted_(client, text, hello->params[index].name)
            || !tltl_add_(client, text, ":") || !tltl_add_number_(client, text, hello->params[index].value))
            return 0;
    return 1;
}

static int tltl_say_hello_(tltl_client *client, const tltl_hello *hello, const char *token) {
    tltl_text_buffer *text = &client->message;
    if (!tltl_begin_message_(client, "{\"hello\":{\"tltl\":1,\"name\":")
        || !tltl_add_quoted_(client, text, hello->name ? hello->name : "game"))
        return 0;
    if (*token && !(tltl_add_(client, text, ",\"token\":") && tltl_add_quoted_(client, text, token))) return 0;
    if (hello->clock_hz > 0
        && !(tltl_add_(client, text, ",\"clock_hz\":") && tltl_add_number_(client, text, hello->clock_hz)))
        return 0;
    return tltl_add_(client, text, ",\"signals\":{") && tltl_add_signals_(client, hello)
           && tltl_add_(client, text, "},\"params\":{") && tltl_add_params_(client, hello)
           && tltl_add_(client, text, "},\"scenes\":[") && tltl_add_words_(client, hello->scenes, hello->scene_count)
           && tltl_add_(client, text, "],\"capabilities\":[") && tltl_add_capabilities_(client, hello->capabilities)
           && tltl_add_(client, text, "]") && tltl_add_member_(client, ",\"actions\":", hello->actions)
           && tltl_add_member_(client, ",\"observation\":", hello->observation) && tltl_add_(client, text, "}}")
           && tltl_send_message_(client);
}

static const char *tltl_environment_(const char *name) {
    const char *value = getenv(name);
    return value ? value : "";
}

int tltl_connect(tltl_client *client, const tltl_hello *hello, int port, const char *token) {
    struct sockaddr_in address;
    tltl_init_(client);
    if (!token) token = tltl_environment_("TLTL_TOKEN");
    if (port == 0) {
        const char *text = tltl_environment_("TLTL_PORT");
        const long number = strtol(text, NULL, 10);
        if (!*text) return tltl_fail_(client, "tltlc must start this game: the variable TLTL_PORT is not set");
        port = number > 0 && number < 65536 ? (int)number : 0;
    }
    address = tltl_address_(port);
    client->connection = tltl_new_socket_();
    if (client->connection < 0
        || connect((tltl_socket_)client->connection, (const struct sockaddr *)&address, sizeof address) != 0)
        return tltl_fail_(client, "cannot connect to tltlc at port %d: %s", port, tltl_socket_error_());
    tltl_set_options_(client->connection);
    return tltl_say_hello_(client, hello, token);
}

// Wait for the first program that connects to the port.
static int tltl_accept_(tltl_client *client, int port) {
    const struct sockaddr_in address = tltl_address_(port);
    const intptr_t server = tltl_new_socket_();
#ifndef _WIN32
    int on = 1;
    if (server >= 0) setsockopt((int)server, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
#endif
    if (server < 0 || bind((tltl_socket_)server, (const struct sockaddr *)&address, sizeof address) != 0
        || listen((tltl_socket_)server, 1) != 0) {
        tltl_fail_(client, "cannot listen on port %d: %s; does this game run twice?", port, tltl_socket_error_());
        tltl_close_socket_(server);
        return 0;
    }
    do {
        client->connection = (intptr_t)accept((tltl_socket_)server, NULL, NULL);
    } while (client->connection < 0 && tltl_was_interrupted_());
    tltl_close_socket_(server);
    if (client->connection < 0)
        return tltl_fail_(client, "cannot accept a connection on port %d: %s", port, tltl_socket_error_());
    tltl_set_options_(client->connection);
    return 1;
}

// Return why the game refuses the first message of tltlc; NULL if it accepts the message.
static const char *tltl_reason_(tltl_client *client, const char *token) {
    const tltl_node *hello, *sent;
    long long version;
    size_t length;
    if (!tltl_read_line_(client, TLTL_LONGEST_FIRST_LINE_, &length)
        || !tltl_read_json_(client, client->received.data, length)
        || !(hello = tltl_member(client->nodes, "hello")) || hello->type != TLTL_OBJECT)
        return "the first line must be a `hello`";
    if (!tltl_whole(tltl_member(hello, "tltl"), &version) || version != TLTL_PROTOCOL)
        return "this game speaks version 1 of the protocol";
    sent = tltl_member(hello, "token");
    if (*token && (!sent || sent->type != TLTL_TEXT || strcmp(sent->text, token) != 0))
        return "the token is wrong: start tltlc with the variable TLTL_TOKEN of this game";
    return NULL;
}

int tltl_listen(tltl_client *client, const tltl_hello *hello, int port, const char *token) {
    tltl_init_(client);
    if (!token) token = tltl_environment_("TLTL_TOKEN");
    for (;;) {
        const char *reason;
        if (!tltl_accept_(client, port)) return 0;
        reason = tltl_reason_(client, token);
        if (!reason) return tltl_say_hello_(client, hello, "");
        client->has_failed = 0;
        tltl_refuse(client, "%s", reason);
        tltl_close(client);
        tltl_init_(client);
    }
}

void tltl_close(tltl_client *client) {
    tltl_text_buffer *buffers[10];
    size_t index;
    buffers[0] = &client->received;
    buffers[1] = &client->message;
    buffers[2] = &client->signals;
    buffers[3] = &client->observation;
    buffers[4] = &client->positions;
    buffers[5] = &client->cause;
    buffers[6] = &client->boxes;
    buffers[7] = &client->polygons;
    buffers[8] = &client->regions;
    buffers[9] = &client->frame;
    for (index = 0; index < 10; ++index) {
        free(buffers[index]->data);
        memset(buffers[index], 0, sizeof *buffers[index]);
    }
    free(client->nodes);
    client->nodes = NULL;
    client->node_count = client->node_capacity = client->used = 0;
    tltl_close_socket_(client->connection);
    client->connection = -1;
    client->has_failed = 1;
}

static const char *tltl_text_member_(const tltl_node *value, const char *name, const char *otherwise) {
    const tltl_node *member = tltl_member(value, name);
    return member && member->type == TLTL_TEXT ? member->text : otherwise;
}

static void tltl_fill_(tltl_request *request) {
    long long number;
    request->scene = tltl_text_member_(request->body, "scene", NULL);
    request->variant = tltl_text_member_(request->body, "variant", "v0");
    if (tltl_whole(tltl_member(request->body, "seed"), &number) && number >= 0) {
        request->has_seed = 1;
        request->seed = (uint64_t)number;
    }
    request->action = tltl_member(request->body, "action");
    request->repeat = 1;
    if (tltl_whole(tltl_member(request->body, "repeat"), &number) && number > 1)
        request->repeat = number < INT_MAX ? (int)number : INT_MAX;
    if (!tltl_whole(tltl_member(request->body, "id"), &request->id)) request->id = -1;
}

int tltl_next_request(tltl_client *client, tltl_request *request) {
    static const char *const names[] = {
        "reset", "step", "snapshot", "restore", "release", "screenshot", "outline", "close"};
    const tltl_node *error;
    size_t length;
    int kind;
    memset(request, 0, sizeof *request);
    request->kind = TLTL_UNKNOWN;
    request->name = "";
    client->has_answered = 0;
    if (client->has_failed || !tltl_read_line_(client, TLTL_LONGEST_REQUEST, &length)
        || !tltl_read_json_(client, client->received.data, length))
        return 0;
    if (client->nodes->type != TLTL_OBJECT) return tltl_fail_(client, "tltlc sent a line that is no object");
    error = tltl_member(client->nodes, "error");
    if (error) return tltl_note_refusal_(client, error);
    for (kind = TLTL_RESET; kind <= TLTL_CLOSE; ++kind) {
        request->body = tltl_member(client->nodes, names[kind]);
        if (request->body) break;
    }
    request->kind = (tltl_kind)kind;
    if (kind < TLTL_UNKNOWN) request->name = names[kind];
    else if (client->nodes->count) request->name = client->nodes[1].text;
    tltl_fill_(request);
    return 1;
}

void tltl_begin_state(tltl_client *client) {
    client->signals.length = client->observation.length = client->positions.length = client->cause.length = 0;
}

int tltl_signal(tltl_client *client, const char *name, double value) {
    if (!tltl_is_finite_(value))
        return tltl_fail_(
            client, "the signal %s is %s, and numbers must be finite", name, tltl_odd_number_(value));
    return tltl_add_key_(client, &client->signals, name) && tltl_add_number_(client, &client->signals, value);
}

int tltl_signal_bool(tltl_client *client, const char *name, int value) {
    return tltl_add_key_(client, &client->signals, name)
           && tltl_add_(client, &client->signals, value ? "true" : "false");
}

static int tltl_add_list_(tltl_client *client, tltl_text_buffer *buffer, const double *numbers, size_t count) {
    size_t index;
    if (!tltl_add_(client, buffer, "[")) return 0;
    for (index = 0; index < count; ++index)
        if ((index && !tltl_add_(client, buffer, ",")) || !tltl_add_number_(client, buffer, numbers[index])) return 0;
    return tltl_add_(client, buffer, "]");
}

static int tltl_add_position_(tltl_client *client, const char *name, const double *numbers, size_t count) {
    return tltl_add_key_(client, &client->positions, name)
           && tltl_add_list_(client, &client->positions, numbers, count);
}

int tltl_position(tltl_client *client, const char *name, double x, double y) {
    double numbers[2];
    numbers[0] = x;
    numbers[1] = y;
    return tltl_add_position_(client, name, numbers, 2);
}

int tltl_position_3d(tltl_client *client, const char *name, double x, double y, double z) {
    double numbers[3];
    numbers[0] = x;
    numbers[1] = y;
    numbers[2] = z;
    return tltl_add_position_(client, name, numbers, 3);
}

int tltl_cause(tltl_client *client, const char *cause) {
    client->cause.length = 0;
    return !cause || tltl_add_quoted_(client, &client->cause, cause);
}

int tltl_observe(tltl_client *client, const double *numbers, size_t count) {
    client->observation.length = 0;
    return tltl_add_list_(client, &client->observation, numbers, count);
}

int tltl_observe_array(
    tltl_client *client, const void *data, size_t bytes, const char *dtype, const size_t *shape, size_t rank) {
    client->observation.length = 0;
    return tltl_add_array_(client, &client->observation, data, bytes, dtype, shape, rank);
}

int tltl_observe_json(tltl_client *client, const char *json) {
    client->observation.length = 0;
    return tltl_add_json_(client, &client->observation, json);
}

int tltl_send_state(tltl_client *client, int has_ended) {
    tltl_text_buffer *text = &client->message;
    if (!tltl_begin_message_(client, "{\"state\":{\"signals\":{") || !tltl_add_buffer_(client, text, &client->signals)
        || !tltl_add_(client, text, has_ended ? "},\"ended\":true" : "},\"ended\":false")
        || !tltl_add_(client, text, ",\"cause\":")
        || !(client->cause.length ? tltl_add_buffer_(client, text, &client->cause)
                                  : tltl_add_(client, text, "null")))
        return 0;
    if (client->observation.length
        && !(tltl_add_(client, text, ",\"observation\":") && tltl_add_buffer_(client, text, &client->observation)))
        return 0;
    if (client->positions.length
        && !(tltl_add_(client, text, ",\"positions\":{") && tltl_add_buffer_(client, text, &client->positions)
             && tltl_add_(client, text, "}")))
        return 0;
    return tltl_add_(client, text, "}}") && tltl_send_message_(client);
}

static int tltl_send_id_(tltl_client *client, const char *start, long long id) {
    char number[32];
    snprintf(number, sizeof number, "%lld", id);
    return tltl_begin_message_(client, start) && tltl_add_(client, &client->message, number)
           && tltl_add_(client, &client->message, "}}") && tltl_send_message_(client);
}

int tltl_send_snapshot(tltl_client *client, long long id) {
    return tltl_send_id_(client, "{\"snapshot\":{\"id\":", id);
}

int tltl_send_release(tltl_client *client, long long id) {
    return tltl_send_id_(client, "{\"release\":{\"id\":", id);
}

static int tltl_add_picture_(
    tltl_client *client, tltl_text_buffer *buffer, const void *pixels, size_t height, size_t width, size_t channels) {
    size_t shape[3];
    shape[0] = height;
    shape[1] = width;
    shape[2] = channels;
    if (channels == 0 || (width && (height > TLTL_LONGEST_MESSAGE / width
                                    || height * width > TLTL_LONGEST_MESSAGE / channels)))
        return tltl_fail_(client, "the picture is too large to be sent, or has no channels");
    return tltl_add_array_(client, buffer, pixels, height * width * channels, "uint8", shape, 3);
}

int tltl_send_picture(tltl_client *client, const void *pixels, size_t height, size_t width, size_t channels) {
    return tltl_begin_message_(client, "{\"screenshot\":")
           && tltl_add_picture_(client, &client->message, pixels, height, width, channels)
           && tltl_add_(client, &client->message, "}") && tltl_send_message_(client);
}

void tltl_begin_outline(tltl_client *client) {
    client->boxes.length = client->polygons.length = client->regions.length = client->frame.length = 0;
}

// Add a list of lists, each of `count` numbers.
static int tltl_add_lists_(
    tltl_client *client, tltl_text_buffer *buffer, const double *numbers, size_t lists, size_t count) {
    size_t index;
    if (!tltl_add_(client, buffer, "[")) return 0;
    for (index = 0; index < lists; ++index)
        if ((index && !tltl_add_(client, buffer, ","))
            || !tltl_add_list_(client, buffer, numbers + index * count, count))
            return 0;
    return tltl_add_(client, buffer, "]");
}

int tltl_bounds(tltl_client *client, const double *box, size_t dimensions) {
    return tltl_add_(client, &client->frame, ",\"bounds\":")
           && tltl_add_lists_(client, &client->frame, box, 2, dimensions);
}

int tltl_boxes(tltl_client *client, const char *name, const double *boxes, size_t count, size_t dimensions) {
    size_t index;
    if (!tltl_add_key_(client, &client->boxes, name) || !tltl_add_(client, &client->boxes, "[")) return 0;
    for (index = 0; index < count; ++index)
        if ((index && !tltl_add_(client, &client->boxes, ","))
            || !tltl_add_lists_(client, &client->boxes, boxes + index * 2 * dimensions, 2, dimensions))
            return 0;
    return tltl_add_(client, &client->boxes, "]");
}

int tltl_polygon(tltl_client *client, const char *name, const double *corners, size_t count) {
    return tltl_add_key_(client, &client->polygons, name)
           && tltl_add_lists_(client, &client->polygons, corners, count, 2);
}

int tltl_region(tltl_client *client, const char *name, const double *box, size_t dimensions) {
    return tltl_add_key_(client, &client->regions, name)
           && tltl_add_lists_(client, &client->regions, box, 2, dimensions);
}

int tltl_image(
    tltl_client *client, const void *pixels, size_t height, size_t width, size_t channels,
    const double west_south_east_north[4]) {
    return tltl_add_(client, &client->frame, ",\"image\":{\"extent\":")
           && tltl_add_list_(client, &client->frame, west_south_east_north, 4)
           && tltl_add_(client, &client->frame, ",\"pixels\":")
           && tltl_add_picture_(client, &client->frame, pixels, height, width, channels)
           && tltl_add_(client, &client->frame, "}");
}

int tltl_send_outline(tltl_client *client) {
    tltl_text_buffer *text = &client->message;
    return tltl_begin_message_(client, "{\"outline\":{\"boxes\":{") && tltl_add_buffer_(client, text, &client->boxes)
           && tltl_add_(client, text, "},\"polygons\":{") && tltl_add_buffer_(client, text, &client->polygons)
           && tltl_add_(client, text, "},\"regions\":{") && tltl_add_buffer_(client, text, &client->regions)
           && tltl_add_(client, text, "}") && tltl_add_buffer_(client, text, &client->frame)
           && tltl_add_(client, text, "}}") && tltl_send_message_(client);
}

tltl_outcome tltl_refuse(tltl_client *client, const char *format, ...) {
    char reason[512];
    va_list values;
    va_start(values, format);
    vsnprintf(reason, sizeof reason, format, values);
    va_end(values);
    tltl_cut_(reason);
    if (tltl_begin_message_(client, "{\"error\":{\"message\":") && tltl_add_quoted_(client, &client->message, reason)
        && tltl_add_(client, &client->message, "}}"))
        tltl_send_message_(client);
    return TLTL_REFUSED;
}

// Play ------------------------------------------------------------------------------------------------------------

tltl_hello tltl_game_hello(const tltl_game *game) {
    tltl_hello hello = game->hello;
    if (game->snapshot && game->restore) hello.capabilities |= TLTL_SNAPSHOTS;
    if (game->release) hello.capabilities |= TLTL_RELEASES;
    if (game->screenshot) hello.capabilities |= TLTL_SCREENSHOTS;
    if (game->outline) hello.capabilities |= TLTL_OUTLINES;
    return hello;
}

static void tltl_answer_outcome_(const tltl_game *game, tltl_client *client, tltl_outcome outcome) {
    if (outcome == TLTL_REFUSED) {
        if (!client->has_answered) tltl_refuse(client, "the request cannot be met");
        return;
    }
    tltl_begin_state(client);
    if (game->describe) game->describe(game->self, client);
    if (!client->has_answered) tltl_send_state(client, outcome == TLTL_ENDED);
}

static void tltl_answer_(const tltl_game *game, tltl_client *client, const tltl_request *request) {
    tltl_outcome outcome = TLTL_GOES_ON;
    int tick;
    if (request->kind == TLTL_RESET && game->reset) {
        tltl_answer_outcome_(game, client, game->reset(game->self, client, request));
    } else if (request->kind == TLTL_STEP && game->step) {
        for (tick = 0; tick < request->repeat && outcome == TLTL_GOES_ON; ++tick)
            outcome = game->step(game->self, client, request);
        tltl_answer_outcome_(game, client, outcome);
    } else if (request->kind == TLTL_SNAPSHOT && game->snapshot) {
        const long long id = game->snapshot(game->self);
        if (id < 0) tltl_refuse(client, "the state cannot be kept");
        else tltl_send_snapshot(client, id);
    } else if (request->kind == TLTL_RESTORE && game->restore) {
        tltl_answer_outcome_(game, client, game->restore(game->self, client, request));
    } else if (request->kind == TLTL_RELEASE && game->release) {
        if (game->release(game->self, request->id)) tltl_send_release(client, request->id);
        else tltl_refuse(client, "there is no snapshot %lld", request->id);
    } else if (request->kind == TLTL_SCREENSHOT && game->screenshot) {
        if (!game->screenshot(game->self, client) && !client->has_answered)
            tltl_refuse(client, "there is no picture now");
    } else if (request->kind == TLTL_OUTLINE && game->outline) {
        tltl_begin_outline(client);
        game->outline(game->self, client);
        if (!client->has_answered) tltl_send_outline(client);
    } else {
        tltl_refuse(client, "this game does not know the request `%s`", request->name);
    }
}

int tltl_serve(const tltl_game *game, tltl_client *client) {
    tltl_request request;
    while (tltl_next_request(client, &request) && request.kind != TLTL_CLOSE) tltl_answer_(game, client, &request);
    tltl_close(client);
    if (game->close) game->close(game->self);
    if (!client->error[0]) return 0;
    fprintf(stderr, "%s\n", client->error);
    return 1;
}

int tltl_play(const tltl_game *game) {
    tltl_client client;
    const tltl_hello hello = tltl_game_hello(game);
    tltl_connect(&client, &hello, 0, NULL);
    return tltl_serve(game, &client);
}

// The recorder ----------------------------------------------------------------------------------------------------

static int tltl_recorder_fail_(tltl_recorder *recorder, const char *format, ...) TLTL_PRINTF_;
static int tltl_recorder_fail_(tltl_recorder *recorder, const char *format, ...) {
    va_list values;
    va_start(values, format);
    vsnprintf(recorder->error, sizeof recorder->error, format, values);
    va_end(values);
    return 0;
}

int tltl_recorder_init(
    tltl_recorder *recorder, const char *folder, const tltl_signal_declaration *signals, size_t signal_count,
    double clock_hz) {
    memset(recorder, 0, sizeof *recorder);
    recorder->signals = signals;
    recorder->signal_count = signal_count;
    recorder->clock_hz = clock_hz;
    recorder->game = "game";
    if (strlen(folder) >= sizeof recorder->folder)
        return tltl_recorder_fail_(recorder, "the path of the folder is too long");
    memcpy(recorder->folder, folder, strlen(folder) + 1);
    return 1;
}

// Make a folder and those that it is in; those that exist, and those that cannot be made, are noticed later.
static void tltl_make_folders_(const char *folder) {
    char path[1024];
    size_t index;
    memcpy(path, folder, strlen(folder) + 1);
    for (index = 1; path[0]; ++index) {
        const char letter = path[index];
        if (letter != '\0' && letter != '/' && letter != '\\') continue;
#ifndef _WIN32
        if (letter == '\\') continue;
#endif
        path[index] = '\0';
#ifdef _WIN32
        _mkdir(path);
#else
        mkdir(path, 0777);
#endif
        path[index] = letter;
        if (letter == '\0') break;
    }
}

// Open a file that must not exist yet.
static FILE *tltl_new_file_(const char *path) {
#ifdef _WIN32
    const int descriptor = _open(path, _O_WRONLY | _O_CREAT | _O_EXCL | _O_BINARY, _S_IREAD | _S_IWRITE);
    return descriptor < 0 ? NULL : _fdopen(descriptor, "wb");
#else
    const int descriptor = open(path, O_WRONLY | O_CREAT | O_EXCL, 0666);
    return descriptor < 0 ? NULL : fdopen(descriptor, "w");
#endif
}

static void tltl_write_cell_(FILE *file, const char *name) {
    if (!strchr(name, ',') && name[0] != '"') {
        fputs(name, file);
        return;
    }
    fputc('"', file);
    for (; *name; ++name) {
        if (*name == '"') fputc('"', file);
        fputc(*name, file);
    }
    fputc('"', file);
}

// Write a text as JSON.
static void tltl_write_quoted_(FILE *file, const char *text) {
    fputc('"', file);
    for (; *text; ++text) {
        if (*text == '"' || *text == '\\') fputc('\\', file);
        if ((unsigned char)*text < 32) fprintf(file, "\\u%04x", (unsigned)*text);
        else fputc(*text, file);
    }
    fputc('"', file);
}

static void tltl_write_or_null_(FILE *file, const char *name, const char *text) {
    fprintf(file, ",\"%s\":", name);
    if (text) tltl_write_quoted_(file, text);
    else fputs("null", file);
}

static void tltl_tape_path_(const tltl_recorder *recorder, char *path, size_t size) {
    snprintf(path, size, "%.*s.tape.jsonl", (int)strlen(recorder->path) - 4, recorder->path);
}

static int tltl_is_there_(const char *path) {
    FILE *file = fopen(path, "rb");
    if (file) fclose(file);
    return file != NULL;
}

// Choose the path of the next trace, with the first number, from a given one, of which there is neither a trace nor a
// tape.  Return this number.
static unsigned tltl_choose_path_(tltl_recorder *recorder, unsigned number) {
    char tape[1080];
    for (;; ++number) {
        snprintf(recorder->path, sizeof recorder->path, "%s/trace-%04u.csv", recorder->folder, number);
        tltl_tape_path_(recorder, tape, sizeof tape);
        if (!tltl_is_there_(recorder->path) && !tltl_is_there_(tape)) return number;
    }
}

// End the row, and see whether all of it was written.
static int tltl_end_row_(tltl_recorder *recorder, FILE *file) {
    fputc('\n', file);
    if (fflush(file) == 0 && !ferror(file)) return 1;
    return tltl_recorder_fail_(recorder, "cannot write %.300s: %s", recorder->path, strerror(errno));
}

int tltl_recorder_begin(tltl_recorder *recorder) {
    return tltl_recorder_begin_scene(recorder, NULL, NULL, -1);
}

int tltl_recorder_begin_scene(tltl_recorder *recorder, const char *scene, const char *variant, long long seed) {
    if (!tltl_recorder_end(recorder)) return 0;
    recorder->has_begun = 1;
    recorder->samples = 0;
    recorder->scene = scene;
    recorder->variant = variant ? variant : "v0";
    recorder->seed = seed;
    recorder->digest[0] = 1;
    recorder->digest[1] = 0;
    tltl_choose_path_(recorder, 1);
    return 1;
}

// Make the file of a trace, with the names of the signals.
static int tltl_make_trace_(tltl_recorder *recorder) {
    unsigned number;
    size_t index;
    tltl_make_folders_(recorder->folder);
    for (number = 1; !recorder->file; ++number) {
        number = tltl_choose_path_(recorder, number);
        recorder->file = tltl_new_file_(recorder->path);
        if (!recorder->file && errno != EEXIST)
            return tltl_recorder_fail_(recorder, "cannot write %.300s: %s", recorder->path, strerror(errno));
    }
    if (recorder->clock_hz > 0) fputs("time", recorder->file);
    for (index = 0; index < recorder->signal_count; ++index) {
        if (index || recorder->clock_hz > 0) fputc(',', recorder->file);
        tltl_write_cell_(recorder->file, recorder->signals[index].name);
    }
    return tltl_end_row_(recorder, recorder->file);
}

static void tltl_write_value_(const tltl_recorder *recorder, FILE *file, size_t index, double value) {
    char text[TLTL_NUMBER_SIZE_];
    if (tltl_is_bool_(&recorder->signals[index])) {
        fputs(value != 0 ? "true" : "false", file);
    } else {
        tltl_number_text_(value, text);
        fputs(text, file);
    }
}

static int tltl_begin_tape_(tltl_recorder *recorder) {
    char text[TLTL_NUMBER_SIZE_], path[1080];
    size_t index;
    FILE *file;
    tltl_tape_path_(recorder, path, sizeof path);
    file = recorder->tape = tltl_new_file_(path);
    if (!file) return tltl_recorder_fail_(recorder, "cannot write %.300s: %s", path, strerror(errno));
    fputs("{\"tape\":1", file);
    tltl_write_or_null_(file, "game", recorder->game);
    tltl_write_or_null_(file, "scene", recorder->scene);
    tltl_write_or_null_(file, "variant", recorder->variant);
    if (recorder->seed < 0) fputs(",\"seed\":null", file);
    else fprintf(file, ",\"seed\":%lld", recorder->seed);
    tltl_number_text_(recorder->clock_hz, text);
    fprintf(file, ",\"spec\":null,\"versions\":{},\"clock_hz\":%s", recorder->clock_hz > 0 ? text : "null");
    for (index = 0; index < recorder->signal_count; ++index) {
        const char *type = recorder->signals[index].type;
        fputs(index ? "," : ",\"signals\":{", file);
        tltl_write_quoted_(file, recorder->signals[index].name);
        fputs(":{\"type\":", file);
        tltl_write_quoted_(file, type ? type : "number");
        fputc('}', file);
    }
    fputs(index ? "}}" : ",\"signals\":{}}", file);
    return tltl_end_row_(recorder, file);
}

// Add a value to the digest, Adler-32 of the bytes of all values; -0 counts as 0.
static void tltl_digest_(uint32_t *digest, double value) {
    uint64_t bits;
    int place;
    memcpy(&bits, &value, sizeof bits);
    // With -ffast-math, a compiler may leave out a comparison with 0 that changes the sign alone.
    if (bits == (uint64_t)1 << 63) bits = 0;
    for (place = 0; place < 64; place += 8) {
        digest[0] = (digest[0] + (uint32_t)(bits >> place & 255)) % 65521;
        digest[1] = (digest[1] + digest[0]) % 65521;
    }
}

// Write a step to the tape, and before the first one the header.
static int tltl_write_step_(tltl_recorder *recorder, const char *action, const double *values) {
    size_t index;
    if (!recorder->tape && !tltl_begin_tape_(recorder)) return 0;
    fprintf(recorder->tape, "{\"action\":%s,\"signals\":{", action);
    for (index = 0; index < recorder->signal_count; ++index) {
        const int is_bool = tltl_is_bool_(&recorder->signals[index]);
        if (index) fputc(',', recorder->tape);
        tltl_write_quoted_(recorder->tape, recorder->signals[index].name);
        fputc(':', recorder->tape);
        tltl_write_value_(recorder, recorder->tape, index, values[index]);
        tltl_digest_(recorder->digest, is_bool ? values[index] != 0 : values[index]);
    }
    fputc('}', recorder->tape);
    if ((recorder->samples + 1) % 60 == 0)
        fprintf(
            recorder->tape, ",\"digest\":\"%04x%04x\"", (unsigned)recorder->digest[1],
            (unsigned)recorder->digest[0]);
    fputc('}', recorder->tape);
    return tltl_end_row_(recorder, recorder->tape);
}

int tltl_recorder_sample(tltl_recorder *recorder, const double *values) {
    return tltl_recorder_step(recorder, NULL, values);
}

int tltl_recorder_step(tltl_recorder *recorder, const char *action, const double *values) {
    char text[TLTL_NUMBER_SIZE_];
    size_t index;
    for (index = 0; index < recorder->signal_count; ++index)
        if (!tltl_is_finite_(values[index]))
            return tltl_recorder_fail_(
                recorder, "the signal %.300s is %s, and numbers must be finite", recorder->signals[index].name,
                tltl_odd_number_(values[index]));
    if (!recorder->has_begun && !tltl_recorder_begin(recorder)) return 0;
    if (!recorder->file && !tltl_make_trace_(recorder)) return 0;
    if (recorder->samples && !action != !recorder->tape)
        return tltl_recorder_fail_(recorder, "give the action of each sample of an episode, or of none");
    if (action && !tltl_write_step_(recorder, action, values)) return 0;
    if (recorder->clock_hz > 0) {
        tltl_number_text_((double)recorder->samples / recorder->clock_hz, text);
        fputs(text, recorder->file);
    }
    for (index = 0; index < recorder->signal_count; ++index) {
        if (index || recorder->clock_hz > 0) fputc(',', recorder->file);
        tltl_write_value_(recorder, recorder->file, index, values[index]);
    }
    ++recorder->samples;
    return tltl_end_row_(recorder, recorder->file);
}

int tltl_recorder_end(tltl_recorder *recorder) {
    FILE *file = recorder->file, *tape = recorder->tape;
    const int is_tape_whole = !tape || fclose(tape) == 0;
    recorder->file = recorder->tape = NULL;
    recorder->has_begun = 0;
    if ((!file || fclose(file) == 0) && is_tape_whole) return 1;
    return tltl_recorder_fail_(recorder, "cannot write %.300s: %s", recorder->path, strerror(errno));
}

#ifdef __cplusplus
}
#endif

#endif  // TLTL_CLIENT_IMPLEMENTATION
