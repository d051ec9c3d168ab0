// Send answers of all kinds with the client in C, and print what arrives; the memory may end: answers [ALLOCATIONS]
//
// With a number, only so many allocations succeed; then it prints nothing, and ends with status 0 if each failure was
// reported by an error.

#ifndef _POSIX_C_SOURCE
#define _POSIX_C_SOURCE 200809L
#endif
#include <stdlib.h>

static long allocations_left = -1;

static void *counted_realloc(void *data, size_t size) {
    if (allocations_left == 0) return NULL;
    if (allocations_left > 0) --allocations_left;
    return realloc(data, size);
}

#define realloc counted_realloc
#define TLTL_LONGEST_MESSAGE ((size_t)1 << 20)
#define TLTL_CLIENT_IMPLEMENTATION
#include "tltl_client.h"

static int quiet;

// Print the messages that have arrived at the other end of the pair.
static void print_messages(int other) {
    char data[4096];
    for (;;) {
        const ssize_t count = recv(other, data, sizeof data, MSG_DONTWAIT);
        if (count <= 0) return;
        if (!quiet) fwrite(data, 1, (size_t)count, stdout);
    }
}

static int send_all(tltl_client *client, const tltl_game *game) {
    static const unsigned char floats[] = {0, 0, 128, 63, 0, 0, 0, 192, 0, 0, 0, 0};  // 1, -2 and 0 as float32
    static const size_t shape[] = {3, 1};
    static const unsigned char pixels[] = {255, 0, 0, 0, 255, 0, 0, 0, 255};
    static const double walls[] = {0, 0, -1, 8, 1, 2.5, 8, 0, -1, 9, 6, 2.5}, lake[] = {1, 1, 3, 1, 2, 2};
    static const double extent[] = {0, 0, 9, 6};
    const tltl_hello hello = tltl_game_hello(game);
    char long_text[1001];
    size_t index;
    int went_well = tltl_say_hello_(client, &hello, "a\"b\\c\x01\xc3\xa4");
    tltl_begin_state(client);
    tltl_signal(client, "near(a, \"b\")", 0.1);
    tltl_signal_bool(client, "seen", 1);
    tltl_observe_array(client, floats, sizeof floats, "float32", shape, 2);
    tltl_position_3d(client, "player", 1, -2.5, 1e-9);
    tltl_position(client, "guard", 0, 3);
    tltl_cause(client, "line\nend");
    went_well &= tltl_send_state(client, 1);
    tltl_begin_state(client);
    tltl_signal(client, "near(a, \"b\")", -1e300);
    tltl_signal_bool(client, "seen", 0);
    tltl_observe_json(client, "{\"map\":\n [1, 2],\r\n \"speed\": 0.5}");
    went_well &= tltl_send_state(client, 0);
    went_well &= tltl_send_snapshot(client, 9007199254740993LL);
    went_well &= tltl_send_picture(client, pixels, 1, 3, 3);
    tltl_begin_outline(client);
    tltl_boxes(client, "wall \"1\"", walls, 2, 3);
    tltl_boxes(client, "fence", walls, 0, 3);
    tltl_polygon(client, "lake", lake, 3);
    tltl_region(client, "hall", extent, 2);
    tltl_region(client, "roof", walls, 3);
    tltl_bounds(client, extent, 2);
    tltl_image(client, pixels, 1, 3, 3, extent);
    went_well &= tltl_send_outline(client);
    tltl_begin_outline(client);
    tltl_bounds(client, walls, 3);
    went_well &= tltl_send_outline(client);
    for (index = 0; index < 1000; index += 2) memcpy(long_text + index, "\xc3\xa4", 2);
    long_text[1000] = '\0';
    tltl_refuse(client, "%s", long_text);  // Byte 511, the last one, is half a letter.
    return went_well && !client->error[0];
}

// Print the reason of a failure, and forget it.
static void print_error(tltl_client *client) {
    if (!quiet) printf("%s\n", client->error);
    client->error[0] = '\0';
    client->has_failed = 0;
}

int main(int argc, char **argv) {
    static const tltl_signal_declaration signals[] = {
        {"near(a, \"b\")", "number", -INFINITY, 1}, {"seen", "bool", 0, 1}, {"free", NULL, 0, 0}};
    static tltl_game game;
    static const char huge[2000000] = {0};
    int pair[2], went_well;
    tltl_client client;
    quiet = argc > 1;
    if (quiet) allocations_left = atol(argv[1]);
    game.hello.signals = signals;
    game.hello.signal_count = 3;
    game.hello.actions = TLTL_BOX(-1, 1, "float32", 2, 3);
    tltl_init_(&client);
    if (socketpair(AF_UNIX, SOCK_STREAM, 0, pair) != 0) return 2;
    client.connection = pair[0];
    went_well = send_all(&client, &game);
    print_messages(pair[1]);
    if (quiet) {
        tltl_close(&client);
        close(pair[1]);
        return went_well || strstr(client.error, "there is no memory") ? 0 : 1;
    }
    tltl_begin_state(&client);
    tltl_signal(&client, "seen", NAN);
    if (tltl_send_state(&client, 0)) return 3;
    print_error(&client);
    if (tltl_send_picture(&client, huge, 1000, 1000, 2)) return 3;
    print_error(&client);
    if (tltl_send_picture(&client, huge, (size_t)-1, (size_t)-1, (size_t)-1)) return 3;
    print_error(&client);
    close(pair[1]);
    if (tltl_send_snapshot(&client, 1) || client.error[0]) return 3;
    tltl_close(&client);
    tltl_close(&client);
    return went_well ? 0 : 4;
}
