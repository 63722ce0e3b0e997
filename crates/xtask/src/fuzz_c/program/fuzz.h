/*
 * A program that calls every function of the C library, in random sequences: each is played again by its seed and number.
 *
 * random.c    numbers
 * room.c      memory that ends where a page does that nobody may touch
 * log.c       the last calls as lines, what is told of a fall, the clock of a call
 * counts.c    what was called, in memory that outlives the program
 * pool.c      live handles, texts and bytes
 * draw.c      what a call is given
 * call.c      one call, and what is checked of it
 * callbacks.c functions of the program
 * recipes.c   models and motions that are known to be right, as lines of calls
 * play.c      a sequence
 * tables.c    the interface, made of pc.h
 */
#ifndef FUZZ_H
#define FUZZ_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <pc.h>

enum { ARGUMENTS = 18, POOL = 4, PAGE = 4096, ROOM_BYTES = 16 * PAGE, WORDS = 64, FUNCTIONS = 512, DEEPEST = 2 };

union value {
    double number;
    size_t count;
    int choice;
    uint64_t wide;
    void *pointer;
    void (*function)(void);
};

enum kind {
    HANDLE, FREED_HANDLE, HANDLE_PLACE, ERROR_PLACE, TEXT, TEXTS, FREED_TEXT, TEXT_PLACE, BYTES, FREED_BYTES, BYTES_PLACE,
    NUMBERS, ROOM, PLACE, POINTER_PLACE, OPTIONS, STRUCTURE, LENGTH, SIZE, NUMBER, COUNT, CHOICE, UNSIGNED, CALLBACK, USER
};

enum result { STATUS, NAME, SOME, WHOLE, REAL, WIDE, NOTHING };

enum member { MEMBER_COUNT, MEMBER_INT, MEMBER_WIDE32, MEMBER_WIDE64, MEMBER_DOUBLE, MEMBER_DOUBLES, MEMBER_INTS, MEMBER_HANDLE, MEMBER_OTHER };

/* of: the type of the handle, structure or callback, or the bytes of an entry; length: the argument that says how many entries, or
   how many states; fixed: how many, if not 0; power: that of the length of the state, if not 0. */
struct argument {
    const char *name;
    enum kind kind;
    int of, length, fixed, power;
    bool real;
};

struct function {
    const char *name;
    enum result result;
    int count;
    struct argument arguments[ARGUMENTS];
    size_t rarity;
    /* Whether null is spoken of, results need not be finite, a handle in use is not freed. */
    bool null, infinite, kept;
    int counted;
    int words;
    const char *vocabulary[WORDS];
    void (*call)(const union value *, union value *);
};

struct handle_type {
    const char *name;
    int free, dim;
};

struct structure {
    const char *name;
    size_t size;
    int init, count;
    struct {
        const char *name;
        size_t place;
        enum member kind;
        int of;
    } members[32];
};

struct callback {
    const char *name;
    void (*function)(void);
};

extern const struct function functions[];
extern const size_t function_count;
extern const struct handle_type handle_types[];
extern const size_t handle_type_count;
extern const struct structure structures[];
extern const struct callback callbacks[];
extern const int statuses[];
extern const size_t status_count;

/* random.c */
void seed_random(uint64_t seed, uint64_t number);
uint64_t draw(void);
size_t below(size_t count);
bool chance(unsigned percent);
double between(double from, double to);

/* room.c */
void set_up_room(void);
size_t room_mark(void);
void room_release(size_t mark);
void *room(size_t bytes, bool read_only);
/* Whether nothing before the rooms since the mark, and nothing in those that are read only, was written. */
bool room_untouched(size_t mark);
void room_seal(size_t mark);

/* log.c */
extern bool tracing;
extern bool fallen;
void set_up_log(uint64_t seed, const char *replay);
void log_sequence(uint64_t number);
size_t log_begin(int depth);
void log_add(const char *format, ...) __attribute__((format(printf, 1, 2)));
void log_text(const char *text);
void log_append(size_t line, const char *format, ...) __attribute__((format(printf, 2, 3)));
void log_show(size_t line);
void fall(const char *format, ...) __attribute__((format(printf, 1, 2)));
void clock_start(void);
void clock_stop(void);
long live_blocks(void);

/* counts.c */
void set_up_counts(const char *path);
void count_call(size_t function, bool succeeded, uint64_t nanoseconds);
void count_fall(void);
void count_sequence(uint64_t number);
void count_end(void);
uint64_t calls_so_far(void);
uint64_t now(void);

/* pool.c */
struct entry {
    void *handle;
    unsigned number;
    /* The calls that use it now. */
    int busy;
    /* Whether its integrations may take very many steps. */
    bool unlimited;
    size_t dim;
    /* Its time, the time that it covers, and a state of it. */
    double t, span, start[64];
    bool has_start;
    uint16_t learned[FUNCTIONS][ARGUMENTS];
};
struct bytes {
    void *data;
    size_t length;
};
extern struct entry *pools[16][POOL];
extern char *texts[POOL];
extern struct bytes blocks[POOL];
void set_up_pools(void);
void empty_pools(void);
/* A live handle of a type, null if there is none; in a call of a function of the program one in use only if that is allowed. */
struct entry *pick(int type, int depth);
struct entry *latest(int type);
bool is_there(int type, int depth);
/* Room for a new handle, null if all are taken. */
struct entry *vacant(int type);
int handle_type(const char *name);
int function_named(const char *name);
void remember_name(const char *name);
const char *some_name(void);

/* callbacks.c */
struct user {
    uint32_t magic;
    bool owned;
    int destroyed;
    size_t calls, good;
    int code, way;
    bool nests;
};
void set_up_users(void);
struct user *new_user(bool owned);
bool users_are_destroyed(void);
int called(void *user);

/* draw.c */
struct call {
    const struct function *function;
    int number, depth;
    /* Whether arguments may be wrong. */
    bool wild;
    union value a[ARGUMENTS];
    struct entry *entries[ARGUMENTS];
    struct entry *first;
    size_t lengths[ARGUMENTS];
    bool length_set[ARGUMENTS];
    /* Where the results of places go. */
    void *places[ARGUMENTS];
    bool overlaps, damaged, unlimited, moderate;
    struct user *user;
    const char *given;
    /* Its line. */
    size_t line;
};
void draw_arguments(struct call *call);
void draw_array(struct call *call, int argument, size_t length);
void show_arguments(const struct call *call);

/* call.c */
enum outcome { SUCCEEDED, FAILED, IMPOSSIBLE };
/* Calls a function with drawn arguments; those of `given`, a list of words, come first. */
enum outcome make(int function, const char *given, bool wild);
enum outcome make_named(const char *function, const char *given, bool wild);
void free_entry(int type, struct entry *entry);
extern int depth;

/* play.c */
void some_call(void);

/* recipes.c */
extern const char *const recipes[];
extern const size_t recipe_count;
extern const char *const model_texts[];
extern const size_t model_text_count;
extern const char *const builtins[];
extern const size_t builtin_count;

#endif
