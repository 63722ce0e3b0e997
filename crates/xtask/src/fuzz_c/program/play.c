/*
 * Sequences of calls: usage: fuzz SEED FIRST STEP CALLS COUNTS [trace]
 *
 * plays the sequences FIRST, FIRST + STEP, ... until CALLS calls are in the file COUNTS, which may hold some already; with `trace`
 * FIRST alone, and shows all calls.
 */
#include "fuzz.h"

#include <sys/stat.h>

/* A sequence that leaves blocks behind is played again: some are made once, or freed later. */
enum { LONGEST = 70, AGAIN = 6 };

/* How often each recipe is followed at the beginning. */
enum { EACH = 4 };

static bool is_possible(const struct function *function)
{
    for (int i = 0; i < function->count; i++) {
        const struct argument *is = &function->arguments[i];
        if ((is->kind == HANDLE || is->kind == FREED_HANDLE) && !is_there(is->of, depth)) {
            return false;
        }
    }
    return true;
}

static bool makes(const struct function *function, int type)
{
    for (int i = 0; i < function->count; i++) {
        if (function->arguments[i].kind == HANDLE_PLACE && (type < 0 || function->arguments[i].of == type)) {
            return true;
        }
    }
    return false;
}

static bool frees(const struct function *function)
{
    return function->count == 1 && function->arguments[0].kind == FREED_HANDLE;
}

/* A function that makes a handle of a type of which there is none, if that can be; else -1. */
static int some_maker(void)
{
    for (int attempt = 0; attempt < 400; attempt++) {
        const size_t number = below(function_count);
        for (size_t type = 0; makes(&functions[number], -1) && type < handle_type_count; type++) {
            if (!is_there((int)type, 0) && makes(&functions[number], (int)type) && is_possible(&functions[number])) {
                return (int)number;
            }
        }
    }
    return -1;
}

/* Whether a function changes a model, of which many more calls do nothing for the systems that were made of it. */
static bool builds(const struct function *function)
{
    return strncmp(function->name, "pc_model_", 9) == 0;
}

static int some_function(void)
{
    const int maker = depth == 0 && chance(20) ? some_maker() : -1;
    if (maker >= 0) {
        return maker;
    }
    const bool lacking = chance(2);
    for (;;) {
        const size_t number = below(function_count);
        const struct function *function = &functions[number];
        const size_t rarity = function->rarity * (frees(function) ? 4 : builds(function) ? 3 : 1);
        if (below(rarity) == 0 && (lacking || is_possible(function))) {
            return (int)number;
        }
    }
}

void some_call(void)
{
    make(some_function(), NULL, chance(30));
}

/* The calls of a recipe, with some more between them. */
static void cook(const char *recipe)
{
    while (*recipe && !fallen) {
        const char *end = strchr(recipe, '\n');
        const size_t length = end ? (size_t)(end - recipe) : strlen(recipe);
        char line[512];
        snprintf(line, sizeof line, "%.*s", (int)length, recipe);
        recipe += length + (end != NULL);
        const bool optional = *line == '?';
        if ((optional && chance(50)) || (!optional && chance(1))) {
            continue;
        }
        char *name = line + optional;
        char *given = strchr(name, ' ');
        if (given) {
            *given++ = '\0';
        }
        make_named(name, given, false);
        if (chance(2)) {
            some_call();
        }
    }
}

static void free_everything(void)
{
    /* In any order: handles are independent. */
    for (int left = 1; left > 0;) {
        left = 0;
        for (size_t type = 0; type < handle_type_count; type++) {
            for (size_t i = 0; i < POOL; i++) {
                struct entry *entry = pools[type][i];
                if (entry->handle && chance(30)) {
                    free_entry((int)type, entry);
                }
                left += entry->handle != NULL;
            }
        }
    }
    for (size_t i = 0; i < POOL; i++) {
        pc_string_free(texts[i]);
        pc_bytes_free(blocks[i].data);
    }
}

static void play(uint64_t seed, uint64_t number)
{
    seed_random(seed, number);
    empty_pools();
    set_up_users();
    log_sequence(number);
    const size_t kind = below(10);
    if (number < EACH * recipe_count) {
        /* So that few sequences suffice for each of them. */
        cook(recipes[number % recipe_count]);
    } else if (kind < 6) {
        cook(recipes[below(recipe_count)]);
    } else if (kind < 8) {
        make_named("pc_model_builtin", NULL, false);
        make_named("pc_system_new", NULL, false);
    } else if (kind < 9) {
        make_named("pc_model_parse", NULL, false);
        make_named("pc_system_new", NULL, false);
    }
    for (size_t calls = 5 + below(LONGEST); calls > 0 && !fallen; calls--) {
        some_call();
    }
    free_everything();
    if (!users_are_destroyed()) {
        fall("data of a function of the program are not destroyed, or not once");
    }
}

/* Plays a sequence, and again if blocks are left behind: what is left behind each time is lost. */
static void play_checked(uint64_t seed, uint64_t number)
{
    long left = 1;
    fallen = false;
    for (int times = 0; times < AGAIN && left > 0 && !fallen; times++) {
        const long before = live_blocks();
        play(seed, number);
        left = live_blocks() - before;
    }
    if (left > 0 && !fallen) {
        fall("%ld blocks are left behind when all handles are freed", left);
    }
}

static void write_file(const char *name, const char *text)
{
    FILE *file = fopen(name, "wb");
    if (!file || fputs(text, file) < 0 || fclose(file) != 0) {
        perror(name);
        exit(2);
    }
}

static void write_files(void)
{
    write_file("table.csv", "t,u\n0,1\n1,2\n2,0.5\n");
    write_file("curve.csv", "t,u,v,a\n0,1,0,0\n1,2,0,0\n2,0.5,0,0\n");
    write_file("model.toml", model_texts[1]);
    write_file("garbage.bin", "\x7f\xff\xfe[x\n\"\x01");
    write_file("empty.toml", "");
    write_file("written-1.bin", "");
    write_file("written-2.bin", "");
    write_file("robot.urdf",
               "<robot name=\"r\"><link name=\"base\"/><link name=\"arm\"><inertial><mass value=\"1\"/>"
               "<inertia ixx=\"0.1\" ixy=\"0\" ixz=\"0\" iyy=\"0.1\" iyz=\"0\" izz=\"0.1\"/></inertial></link>"
               "<joint name=\"hinge\" type=\"continuous\"><parent link=\"base\"/><child link=\"arm\"/><axis xyz=\"0 1 0\"/></joint>"
               "</robot>\n");
}

int main(int argc, char **argv)
{
    if (argc < 6) {
        fprintf(stderr, "usage: %s SEED FIRST STEP CALLS COUNTS [trace]\n", argv[0]);
        return 2;
    }
    const uint64_t seed = strtoull(argv[1], NULL, 10), first = strtoull(argv[2], NULL, 10), step = strtoull(argv[3], NULL, 10);
    const uint64_t calls = strtoull(argv[4], NULL, 10);
    if (function_count > FUNCTIONS || handle_type_count > sizeof pools / sizeof *pools) {
        fprintf(stderr, "the interface has outgrown FUNCTIONS or `pools` of fuzz.h\n");
        return 2;
    }
    tracing = argc > 6;
    set_up_counts(argv[5]);
    set_up_room();
    set_up_pools();
    set_up_log(seed, "replay: cargo xtask fuzz c --replay ");
    write_files();
    for (uint64_t number = first; calls_so_far() < calls; number += step) {
        count_sequence(number);
        play_checked(seed, number);
        if (tracing) {
            break;
        }
    }
    count_end();
    return 0;
}
