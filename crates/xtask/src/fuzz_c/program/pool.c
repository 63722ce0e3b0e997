/* What lives: handles by their types, texts and bytes that are to be freed, and names that are known to the model. */
#include "fuzz.h"

enum { NAMES = 48, NAME_BYTES = 64 };

struct entry *pools[16][POOL];
char *texts[POOL];
struct bytes blocks[POOL];

static unsigned next_number;
static char names[NAMES][NAME_BYTES];
static size_t name_count;

/* Names of models that are often right. */
static const char *const common[] = { "x",   "y",   "z",     "q1",    "q2",    "x'",  "y'",    "m",     "g",    "k", "t",
                                      "u",   "v",   "θ",     "φ",     "ω",     "arm", "world", "bob",   "link", "tip",
                                      "pin", "hit", "rail",  "floor", "wheel", "c1",  "energy", "ω1",    "γ1",   "s" };

void set_up_pools(void)
{
    for (size_t type = 0; type < handle_type_count; type++) {
        for (size_t i = 0; i < POOL; i++) {
            pools[type][i] = calloc(1, sizeof(struct entry));
        }
    }
}

void empty_pools(void)
{
    for (size_t type = 0; type < handle_type_count; type++) {
        for (size_t i = 0; i < POOL; i++) {
            pools[type][i]->handle = NULL;
            pools[type][i]->busy = 0;
        }
    }
    memset(texts, 0, sizeof texts);
    memset(blocks, 0, sizeof blocks);
    next_number = 0;
    name_count = 0;
}

/* A handle in use may be given to another call only where the library notices that: it then does not free it either. */
static bool may_be_used(int type, const struct entry *entry, int depth)
{
    const int free = handle_types[type].free;
    return entry->handle && (entry->busy == 0 || (depth > 0 && free >= 0 && functions[free].kept));
}

struct entry *pick(int type, int depth)
{
    struct entry *found[POOL];
    size_t count = 0;
    for (size_t i = 0; i < POOL; i++) {
        if (may_be_used(type, pools[type][i], depth)) {
            found[count++] = pools[type][i];
        }
    }
    return count == 0 ? NULL : found[below(count)];
}

struct entry *latest(int type)
{
    struct entry *found = NULL;
    for (size_t i = 0; i < POOL; i++) {
        struct entry *entry = pools[type][i];
        if (entry->handle && (!found || entry->number > found->number)) {
            found = entry;
        }
    }
    return found;
}

bool is_there(int type, int depth)
{
    for (size_t i = 0; i < POOL; i++) {
        if (may_be_used(type, pools[type][i], depth)) {
            return true;
        }
    }
    return false;
}

struct entry *vacant(int type)
{
    for (size_t i = 0; i < POOL; i++) {
        struct entry *entry = pools[type][i];
        if (!entry->handle) {
            memset(entry, 0, sizeof *entry);
            entry->number = ++next_number;
            return entry;
        }
    }
    return NULL;
}

int handle_type(const char *name)
{
    for (size_t type = 0; type < handle_type_count; type++) {
        if (strcmp(handle_types[type].name, name) == 0) {
            return (int)type;
        }
    }
    return -1;
}

int function_named(const char *name)
{
    for (size_t i = 0; i < function_count; i++) {
        if (strcmp(functions[i].name, name) == 0) {
            return (int)i;
        }
    }
    fprintf(stderr, "there is no function %s\n", name);
    exit(2);
}

void remember_name(const char *name)
{
    if (!name || !*name || strlen(name) >= NAME_BYTES) {
        return;
    }
    for (size_t i = 0; i < NAMES && i < name_count; i++) {
        if (strcmp(names[i], name) == 0) {
            return;
        }
    }
    strcpy(names[name_count++ % NAMES], name);
}

const char *some_name(void)
{
    const size_t known = name_count < NAMES ? name_count : NAMES;
    return known > 0 && chance(75) ? names[below(known)] : common[below(sizeof common / sizeof *common)];
}
