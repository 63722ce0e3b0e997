/* Memory for arguments: each piece ends where a page begins that nobody may touch, and a known pattern stands before it. */
#include "fuzz.h"

#include <sys/mman.h>

enum { ROOMS = 160, BEFORE = 64, PATTERN = 0xa5 };

static unsigned char *base;
static struct {
    size_t bytes;
    bool read_only;
    uint64_t hash;
} rooms[ROOMS];
static size_t used;

static unsigned char *end_of(size_t number)
{
    return base + number * (ROOM_BYTES + PAGE) + ROOM_BYTES;
}

static uint64_t hash_of(size_t number)
{
    uint64_t hash = 14695981039346656037u;
    const unsigned char *byte = end_of(number) - rooms[number].bytes;
    for (size_t i = 0; i < rooms[number].bytes; i++) {
        hash = (hash ^ byte[i]) * 1099511628211u;
    }
    return hash;
}

void set_up_room(void)
{
    const size_t each = ROOM_BYTES + PAGE;
    base = mmap(NULL, ROOMS * each, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (base == MAP_FAILED) {
        perror("mmap");
        exit(2);
    }
    for (size_t i = 0; i < ROOMS; i++) {
        mprotect(end_of(i), PAGE, PROT_NONE);
    }
}

size_t room_mark(void)
{
    return used;
}

void room_release(size_t mark)
{
    used = mark;
}

void *room(size_t bytes, bool read_only)
{
    if (bytes > ROOM_BYTES - BEFORE || used == ROOMS) {
        fprintf(stderr, "the program has no room for %zu bytes\n", bytes);
        abort();
    }
    unsigned char *start = end_of(used) - bytes;
    memset(start - BEFORE, PATTERN, BEFORE);
    rooms[used].bytes = bytes;
    rooms[used].read_only = read_only;
    used++;
    return start;
}

void room_seal(size_t mark)
{
    for (size_t i = mark; i < used; i++) {
        rooms[i].hash = rooms[i].read_only ? hash_of(i) : 0;
    }
}

bool room_untouched(size_t mark)
{
    for (size_t i = mark; i < used; i++) {
        const unsigned char *start = end_of(i) - rooms[i].bytes;
        for (size_t before = 1; before <= BEFORE; before++) {
            if (start[-(ptrdiff_t)before] != PATTERN) {
                return false;
            }
        }
        if (rooms[i].read_only && rooms[i].hash != hash_of(i)) {
            return false;
        }
    }
    return true;
}
