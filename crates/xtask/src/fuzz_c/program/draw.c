/* What a call is given: by the type of an argument and, where that is not enough, by its name. */
#include "fuzz.h"

#include <float.h>
#include <limits.h>
#include <math.h>

enum { LONGEST_WORD = 4096, MOST_TEXTS = 16 };

static const double strange[] = { 0.0, -0.0, 1.0, -1.0, NAN, INFINITY, -INFINITY, 1e300, -1e300, 5e-324, -1e-310, DBL_MAX, 1e-16, 1e9 };
static const size_t large[] = { SIZE_MAX, SIZE_MAX / 2, SIZE_MAX / 8 + 1, (size_t)1 << 32, 1000 };

/* What a name says of a number. */
static const char *const of_time[] = { "t", "towards", "t_end", "time", NULL };
static const char *const of_tolerance[] = { "relative", "absolute", "relative_tolerance", "absolute_tolerance", "tolerance", NULL };
static const char *const of_length[] = { "length", "max_step", "min_step", "initial_step", "step", NULL };
static const char *const of_part[] = { "accumulation", NULL };
/* Numbers of pieces of a motion, all of which are integrated. */
static const char *const of_pieces[] = { "intervals", "transient", NULL };
/* Numbers that may be as large as one likes, since they only say which; and how often others are 0 to 5. */
static const char *const which[] = { "index", "event", "parameter", "number", "degree", "threads", "samples", "size",
                                     "column", "row", "output", "input", "force", "constraint", NULL };

/* What a name says of a text. */
static const char *const of_name[] = { "name", "coordinate", "body", "parent", "followed", "first", "second", "on", "event",
                                       "variable", "constraint", "integral", "left", "right", "names", "label", "variables",
                                       "outputs", "inputs", "parameters", "parameter", "output", "input", NULL };
static const char *const of_expression[] = { "expression", "definition", "velocity", "when", "mass", "x", "y", "z", "pitch",
                                             "ratio", "offset", "armature", "stiffness", "rest", "damping", "friction",
                                             "lower", "upper", "restitution", "stiction", "value", "length", "f", "g",
                                             "functions", "entries", "values", "places", "angles", NULL };
static const char *const of_column[] = { "column", "rate", "acceleration", "time", NULL };
static const char *const files[] = { "table.csv", "curve.csv", "model.toml", "robot.urdf", "garbage.bin", "empty.toml",
                                     "missing.toml", ".", "/nonexistent/x", "written-1.bin", "written-2.bin" };

static bool is_one_of(const char *name, const char *const *list)
{
    for (; *list; list++) {
        if (strcmp(*list, name) == 0) {
            return true;
        }
    }
    return false;
}

/* Whether this argument is to be wrong. */
static bool odd(const struct call *call)
{
    return call->wild && chance(20);
}

/* The next of the given words, copied to `word`; false if there is none, or if it is to be drawn: `*`. */
static bool next_word(struct call *call, char *word, bool *null)
{
    const char *at = call->given;
    while (at && *at == ' ') {
        at++;
    }
    if (!at || !*at || *at == ']') {
        return false;
    }
    const char end = *at == '`' ? '`' : ' ';
    const bool quoted = end == '`';
    at += quoted;
    size_t length = 0;
    while (*at && *at != end && (quoted || *at != ']') && length < LONGEST_WORD - 1) {
        word[length++] = *at++;
    }
    word[length] = '\0';
    call->given = at + (quoted && *at == '`');
    *null = !quoted && strcmp(word, "-") == 0;
    return quoted || strcmp(word, "*") != 0;
}

static double draw_number(const struct call *call, const char *name)
{
    if (odd(call)) {
        const double number = strange[below(sizeof strange / sizeof *strange)];
        const bool far = fabs(number) > 100.0 && isfinite(number);
        const bool unlimited = call->unlimited || (call->first && call->first->unlimited);
        return far && unlimited ? 2.0 : number;
    }
    if (is_one_of(name, of_tolerance)) {
        return pow(10.0, between(-10.0, -3.0));
    }
    if (is_one_of(name, of_length)) {
        return between(0.01, 1.0);
    }
    if (is_one_of(name, of_part)) {
        return chance(30) ? 0.0 : pow(10.0, between(-6.0, -1.0));
    }
    if (is_one_of(name, of_time)) {
        const double from = call->first ? call->first->t : 0.0;
        const double span = call->first && call->first->span != 0.0 ? call->first->span : 1.5;
        return chance(10) ? from : chance(85) ? from + span * between(0.0, 1.0) : between(-2.0, 2.0);
    }
    switch (below(4)) {
    case 0: return between(0.0, 2.0);
    case 1: return (double)below(4) / 2.0;
    default: return between(-3.0, 3.0);
    }
}

static size_t draw_count(const struct call *call, const char *name)
{
    if (odd(call) && is_one_of(name, which)) {
        return large[below(sizeof large / sizeof *large)];
    }
    if (strcmp(name, "degree") == 0) {
        return chance(80) ? 1 : below(4);
    }
    if (strcmp(name, "states") == 0 || strcmp(name, "members") == 0 || strncmp(name, "samples", 7) == 0) {
        return 1 + below(5) - (odd(call) ? 1 : 0);
    }
    return chance(60) ? below(2) : below(7);
}

static int draw_choice(const struct call *call)
{
    static const int far[] = { INT_MAX, INT_MIN, -2, 100, 7 };
    if (odd(call)) {
        return far[below(5)];
    }
    return chance(85) ? (int)below(2) : (int)below(5) - 1;
}

static uint64_t draw_unsigned(const struct call *call, const char *name)
{
    if (is_one_of(name, of_pieces)) {
        return odd(call) ? below(40) : 1 + below(4);
    }
    return odd(call) ? UINT_MAX : below(4);
}

/* A text in room of its own, ended by zero. */
static char *text_of(const char *bytes, size_t length)
{
    char *text = room(length + 1, true);
    memcpy(text, bytes, length);
    text[length] = '\0';
    return text;
}

static void draw_expression(char *text, size_t room_of_text)
{
    static const char *const patterns[] = { "%s",           "%s^2/2",     "%s*%s",       "sin(%s)",    "2*%s",       "0",
                                            "1",            "-%s",        "sqrt(%s)",    "exp(%s)",    "1/%s",       "%s'^2/2",
                                            "abs(%s)",      "0.5",        "%s - %s",     "%s + 2*%s",  "%s*cos(t)",  "-%s/2",
                                            "atan2(%s, %s)", "%s^%s",     "t",           "1e300*%s",   "log(%s)",    "(%s'^2 + %s'^2)/2",
                                            "1/10",         "sign(%s)",   "min(%s, %s)", "tanh(9*%s)", "%s'",        "%s(%s)",
                                            "((%s",         "%s + ",      "3 %s",        "%s = 1" };
    const size_t count = sizeof patterns / sizeof *patterns;
    const char *a = some_name(), *b = some_name();
    /* The last five are no expressions. */
    const char *pattern = patterns[chance(92) ? below(count - 5) : below(count)];
    const char *second = strchr(pattern, '%') ? strchr(strchr(pattern, '%') + 1, '%') : NULL;
    if (second) {
        const size_t head = (size_t)(second - pattern);
        snprintf(text, room_of_text, "%.*s", (int)head, pattern);
        char begin[256];
        const char *sign = strchr(text, '%');
        snprintf(begin, sizeof begin, "%.*s%s%s", (int)(sign - text), text, a, sign + 2);
        snprintf(text, room_of_text, "%s%s%s", begin, b, second + 2);
    } else if (strchr(pattern, '%')) {
        const char *sign = strchr(pattern, '%');
        snprintf(text, room_of_text, "%.*s%s%s", (int)(sign - pattern), pattern, a, sign + 2);
    } else {
        snprintf(text, room_of_text, "%s", pattern);
    }
}

/* A text that is wrong nearly everywhere; null among them. */
static char *draw_odd_text(void)
{
    static const char *const odd_texts[] = { "",  " ", "\n", "x y", "\"", "[", "]\n[x]\n", "\xff\xfe", "\xc3", "a\xed\xa0\x80",
                                             "\u202ex", "x''", "x'''", "'", "1e999", "\x01", "#", "=", "-", "0x10", "NaN",
                                             "inf", "e\xcc\x81", "\xef\xbb\xbfx", "%s%n", "..", "a.b", "λ_c" };
    char text[8000];
    size_t length = 1 + below(sizeof text - 1);
    switch (below(6)) {
    case 0: return NULL;
    case 1:
        memset(text, chance(50) ? 'a' : '(', length);
        return text_of(text, length);
    case 2:
        length = 1 + below(40);
        for (size_t i = 0; i < length; i++) {
            text[i] = (char)(1 + below(255));
        }
        return text_of(text, length);
    default: {
        const char *known = odd_texts[below(sizeof odd_texts / sizeof *odd_texts)];
        return text_of(known, strlen(known));
    }
    }
}

static char *draw_text(struct call *call, const char *name)
{
    const struct function *function = call->function;
    char text[LONGEST_WORD];
    if (odd(call)) {
        return draw_odd_text();
    }
    const char *known = NULL;
    if (strcmp(name, "path") == 0) {
        const bool writes = strstr(function->name, "save") || strstr(function->name, "write");
        known = writes ? files[7 + below(4)] : files[below(sizeof files / sizeof *files)];
    } else if (strstr(function->name, "builtin")) {
        known = builtins[below(builtin_count)];
    } else if (strcmp(name, "text") == 0) {
        known = model_texts[below(model_text_count)];
    } else if (is_one_of(name, of_column) && strstr(function->name, "file")) {
        static const char *const columns[] = { "t", "u", "v", "a", "none" };
        known = chance(10) ? NULL : columns[below(5)];
        if (!known) {
            return NULL;
        }
    } else if (is_one_of(name, of_expression)) {
        draw_expression(text, sizeof text);
        known = text;
    } else if (is_one_of(name, of_name)) {
        if (function->null && chance(10)) {
            return NULL;
        }
        known = some_name();
    } else if (function->words > 0 && chance(80)) {
        known = function->vocabulary[below((size_t)function->words)];
    } else if (function->null && chance(30)) {
        return NULL;
    } else {
        known = some_name();
    }
    char *copy = text_of(known, strlen(known));
    if (strcmp(name, "text") == 0 && call->wild && chance(50) && *copy) {
        /* Texts of models with a letter that is another one. */
        copy[below(strlen(copy))] = (char)(1 + below(255));
    }
    return copy;
}

/* The length of the state that belongs to the call. */
static size_t dim_of(const struct call *call)
{
    return call->first && call->first->dim > 0 ? call->first->dim : 3;
}

/* How many entries an array is to have. */
static size_t expected_length(const struct call *call, int argument)
{
    const struct argument *is = &call->function->arguments[argument];
    if (is->fixed > 0) {
        return (size_t)is->fixed;
    }
    const size_t dim = dim_of(call);
    if (is->power > 0) {
        const size_t times = is->length < 0 ? 1 : call->a[is->length].count;
        return (is->power == 2 ? dim * dim : dim) * times;
    }
    if (call->first && call->first->learned[call->number][argument] > 0) {
        return (size_t)call->first->learned[call->number][argument] - 1;
    }
    if (is->kind == TEXTS) {
        return (size_t[]){ 1, 2, 3, 6, 9 }[below(5)];
    }
    if (strcmp(is->name, "times") == 0) {
        return 1 + below(4);
    }
    return dim;
}

static void fill_real(const struct call *call, const struct argument *is, double *numbers, size_t length)
{
    const struct entry *first = call->first;
    if (strcmp(is->name, "times") == 0) {
        double t = first ? first->t : 0.0;
        const double direction = chance(90) ? 1.0 : -1.0;
        for (size_t i = 0; i < length; i++) {
            numbers[i] = t;
            t += direction * between(0.01, 0.5);
        }
    } else if (first && first->has_start && length == first->dim) {
        const double by = chance(50) ? 0.0 : 0.1;
        for (size_t i = 0; i < length; i++) {
            numbers[i] = first->start[i] + by * between(-1.0, 1.0);
        }
    } else {
        const bool positive = chance(70);
        for (size_t i = 0; i < length; i++) {
            numbers[i] = positive ? between(0.2, 2.0) : between(-2.0, 2.0);
        }
    }
    if (length > 0 && odd(call)) {
        numbers[below(length)] = strange[below(sizeof strange / sizeof *strange)];
    }
}

void draw_array(struct call *call, int argument, size_t length)
{
    const struct argument *is = &call->function->arguments[argument];
    const bool read = is->kind == NUMBERS;
    unsigned char *numbers = room(length * (size_t)is->of, read);
    if (is->real) {
        fill_real(call, is, (double *)(void *)numbers, length);
    } else {
        for (size_t i = 0; i < length * (size_t)is->of; i++) {
            numbers[i] = is->of > 1 && i % (size_t)is->of > 0 ? 0 : (unsigned char)below(4);
        }
    }
    call->a[argument].pointer = numbers;
    call->lengths[argument] = length;
    if (is->kind != TEXTS && is->power == 0 && is->length >= 0) {
        call->a[is->length].count = length;
    }
}

/* The length of an array, and whether it is null. */
static size_t length_of(struct call *call, int argument, bool *null)
{
    const struct argument *is = &call->function->arguments[argument];
    const bool has_length = is->length >= 0 && is->power == 0;
    *null = false;
    if (has_length && call->length_set[is->length]) {
        /* Another array of this length may be null, with any length. */
        const size_t shared = call->a[is->length].count;
        *null = shared > MOST_TEXTS || (is->kind == NUMBERS && call->function->null && chance(15));
        return shared;
    }
    size_t length = expected_length(call, argument);
    /* Lists of indices fit together less often than numbers. */
    const bool of_indices = is->kind == NUMBERS && !is->real;
    if (is->kind != ROOM && has_length && call->function->null && chance(of_indices ? 60 : 20)) {
        *null = true;
        length = 0;
    } else if (odd(call)) {
        if (chance(30)) {
            /* Null with any length. */
            *null = true;
            length = chance(50) ? large[below(4)] : below(9);
        } else if (has_length) {
            const size_t near[] = { 0, length + 1, length - (length > 0), below(20) };
            length = near[below(4)];
        }
    }
    if (!*null && length > (ROOM_BYTES - PAGE) / (is->of > 0 ? (size_t)is->of : 1)) {
        length = 3;
    }
    if (has_length) {
        call->length_set[is->length] = true;
        call->a[is->length].count = length;
    }
    return length;
}

static void draw_numbers(struct call *call, int argument)
{
    const struct argument *is = &call->function->arguments[argument];
    const char *given = call->given;
    while (given && *given == ' ') {
        given++;
    }
    if (is->kind == NUMBERS && is->real && given && *given == '[') {
        double numbers[MOST_TEXTS];
        size_t length = 0;
        char word[LONGEST_WORD];
        bool null;
        call->given = given + 1;
        while (length < MOST_TEXTS && next_word(call, word, &null)) {
            numbers[length++] = strtod(word, NULL);
        }
        call->given += *call->given == ']';
        draw_array(call, argument, length);
        /* The room is sealed only when all arguments are drawn. */
        memcpy(call->a[argument].pointer, numbers, length * sizeof *numbers);
        if (is->length >= 0) {
            call->length_set[is->length] = true;
        }
        return;
    }
    bool null;
    const size_t length = length_of(call, argument, &null);
    if (null) {
        call->a[argument].pointer = NULL;
        call->lengths[argument] = is->power > 0 || is->length < 0 ? 0 : length;
        return;
    }
    /* Now and then what is written is what is read, which is refused. */
    for (int other = 0; other < argument && is->kind == ROOM && call->wild; other++) {
        const struct argument *before = &call->function->arguments[other];
        if ((before->kind == NUMBERS || before->kind == ROOM) && before->of == is->of && call->a[other].pointer &&
            length > 0 && call->lengths[other] >= length && chance(6)) {
            unsigned char *shared = call->a[other].pointer;
            call->a[argument].pointer = shared + below(call->lengths[other] - length + 1) * (size_t)is->of;
            call->lengths[argument] = length;
            call->overlaps = true;
            return;
        }
    }
    draw_array(call, argument, length);
}

static void draw_texts(struct call *call, int argument)
{
    const struct argument *is = &call->function->arguments[argument];
    const char *list[MOST_TEXTS];
    size_t length = 0;
    while (call->given && *call->given == ' ') {
        call->given++;
    }
    if (call->given && *call->given == '[') {
        char word[LONGEST_WORD];
        bool null;
        call->given++;
        while (length < MOST_TEXTS && next_word(call, word, &null)) {
            list[length++] = null ? NULL : text_of(word, strlen(word));
        }
        call->given += *call->given == ']';
    } else {
        bool null;
        length = length_of(call, argument, &null);
        if (null) {
            call->a[argument].pointer = NULL;
            call->lengths[argument] = length;
            return;
        }
        length = length < MOST_TEXTS ? length : MOST_TEXTS;
        for (size_t i = 0; i < length; i++) {
            list[i] = draw_text(call, is->name);
        }
    }
    void *copy = room(length * sizeof *list, true);
    memcpy(copy, list, length * sizeof *list);
    call->a[argument].pointer = copy;
    call->lengths[argument] = length;
    if (is->length >= 0) {
        call->length_set[is->length] = true;
        call->a[is->length].count = length;
    }
}

static void draw_one_text(struct call *call, int argument)
{
    const struct argument *is = &call->function->arguments[argument];
    char word[LONGEST_WORD];
    bool null = false;
    char *text = next_word(call, word, &null) ? (null ? NULL : text_of(word, strlen(word))) : draw_text(call, is->name);
    if (text && is_one_of(is->name, of_name)) {
        remember_name(text);
    }
    if (is->length >= 0) {
        /* The text has a length and no zero: it ends where the room does. */
        size_t length = text ? strlen(text) : 0;
        if (text && odd(call)) {
            length = below(length + 1);
        }
        char *bare = text ? room(length, true) : NULL;
        if (bare) {
            memcpy(bare, text, length);
        }
        call->a[is->length].count = !bare && odd(call) ? large[below(4)] : length;
        text = bare;
    }
    call->a[argument].pointer = text;
}

static void draw_bytes(struct call *call, int argument)
{
    const struct argument *is = &call->function->arguments[argument];
    const struct bytes *block = &blocks[below(POOL)];
    for (int i = 0; i < POOL && !block->data; i++) {
        block = &blocks[i];
    }
    size_t length = block->data ? block->length : below(200);
    if (length > ROOM_BYTES - PAGE) {
        length = ROOM_BYTES - PAGE;
    }
    if (odd(call) && chance(30)) {
        call->a[argument].pointer = NULL;
        call->a[is->length].count = chance(50) ? large[below(4)] : 0;
        return;
    }
    const size_t whole = length;
    length = odd(call) ? below(length + 1) : length;
    unsigned char *bytes = room(length, true);
    memset(bytes, 0, length);
    if (block->data) {
        memcpy(bytes, block->data, length);
    }
    const bool changed = length > 0 && odd(call);
    if (changed) {
        bytes[below(length)] ^= (unsigned char)(1u << below(8));
    }
    call->damaged = changed || length < whole || !block->data;
    call->a[argument].pointer = bytes;
    call->a[is->length].count = length;
}

static void set_member(const struct call *call, const struct structure *structure, int member, unsigned char *data)
{
    const char *name = structure->members[member].name;
    unsigned char *place = data + structure->members[member].place;
    int choice = draw_choice(call);
    switch (structure->members[member].kind) {
    case MEMBER_INT:
        choice = strcmp(name, "reserved") == 0 ? (odd(call) ? 1 : 0) : odd(call) ? choice : (int)below(5);
        memcpy(place, &choice, sizeof choice);
        break;
    case MEMBER_WIDE32: {
        const uint32_t number = strcmp(name, "reserved") == 0 ? (odd(call) ? 1 : 0) : odd(call) ? 0 : 1 + (uint32_t)below(6);
        memcpy(place, &number, sizeof number);
        break;
    }
    case MEMBER_WIDE64: {
        const bool memory = strstr(name, "memory") != NULL;
        const uint64_t number = memory ? (chance(70) ? (uint64_t)1 << 30 : below(200000)) : 1 + below(500);
        memcpy(place, &number, sizeof number);
        break;
    }
    case MEMBER_DOUBLE: {
        double number = draw_number(call, name);
        if (strcmp(name, "time_limit") == 0 && !odd(call)) {
            number = chance(70) ? 10.0 : chance(50) ? 0.01 : 1e-9;
        } else if (strcmp(name, "stop_time") == 0 && !odd(call)) {
            number = chance(50) ? INFINITY : between(0.5, 3.0);
        }
        memcpy(place, &number, sizeof number);
        break;
    }
    case MEMBER_DOUBLES:
        if (member + 1 < structure->count && structure->members[member + 1].kind == MEMBER_COUNT) {
            size_t length = odd(call) ? below(9) : dim_of(call);
            double *numbers = room(length * sizeof *numbers, true);
            for (size_t i = 0; i < length; i++) {
                numbers[i] = odd(call) ? draw_number(call, name) : pow(10.0, between(-12.0, -4.0));
            }
            memcpy(place, &numbers, sizeof numbers);
            memcpy(data + structure->members[member + 1].place, &length, sizeof length);
        }
        break;
    case MEMBER_INTS:
        /* What each component has to satisfy; most demands make the start wrong. */
        if (member + 1 < structure->count && structure->members[member + 1].kind == MEMBER_COUNT &&
            (odd(call) || chance(15))) {
            const size_t length = odd(call) ? below(9) : dim_of(call);
            int *numbers = room(length * sizeof *numbers, true);
            for (size_t i = 0; i < length; i++) {
                numbers[i] = chance(80) ? 0 : draw_choice(call);
            }
            memcpy(place, &numbers, sizeof numbers);
            memcpy(data + structure->members[member + 1].place, &length, sizeof length);
        }
        break;
    case MEMBER_HANDLE: {
        const struct entry *entry = pick(structure->members[member].of, 0);
        void *handle = entry ? entry->handle : NULL;
        memcpy(place, &handle, sizeof handle);
        break;
    }
    case MEMBER_COUNT:
    case MEMBER_OTHER: break;
    }
}

static int member_named(const struct structure *structure, const char *name, size_t length)
{
    for (int i = 0; i < structure->count; i++) {
        const char *known = structure->members[i].name;
        if (strlen(known) == length && strncmp(known, name, length) == 0) {
            return i;
        }
    }
    return -1;
}

static bool gives_options(const struct call *call)
{
    return call->given && call->given[strspn(call->given, " ")] == '{';
}

/* Whether choices are given, `{method 1 iteration 0}`, which are then set. */
static bool set_given(struct call *call, const struct structure *structure, unsigned char *data)
{
    if (!gives_options(call)) {
        return false;
    }
    const char *at = strchr(call->given, '{');
    for (at++; *at && *at != '}'; at += strspn(at, " ")) {
        const size_t length = strcspn(at, " }");
        const int member = member_named(structure, at, length);
        if (member < 0 || structure->members[member].kind != MEMBER_INT) {
            fprintf(stderr, "%s has no choice %.*s\n", structure->name, (int)length, at);
            exit(2);
        }
        char *end;
        const int choice = (int)strtol(at + length, &end, 10);
        memcpy(data + structure->members[member].place, &choice, sizeof choice);
        at = end;
    }
    call->given = at + (*at == '}');
    return true;
}

static void draw_options(struct call *call, int argument)
{
    const struct structure *structure = &structures[call->function->arguments[argument].of];
    const int steps = member_named(structure, "max_steps", strlen("max_steps"));
    if (!gives_options(call) && chance(20)) {
        call->a[argument].pointer = NULL;
        call->unlimited = call->unlimited || steps >= 0;
        return;
    }
    unsigned char *full = room(structure->size, true);
    memset(full, 0, structure->size);
    if (structure->init >= 0) {
        union value a[ARGUMENTS], r;
        memset(a, 0, sizeof a);
        a[0].pointer = full;
        a[1].count = structure->size;
        functions[structure->init].call(a, &r);
    } else {
        memcpy(full, &structure->size, sizeof structure->size);
    }
    if (steps >= 0 && chance(85)) {
        const uint64_t most = 100 + below(1500);
        memcpy(full + structure->members[steps].place, &most, sizeof most);
    } else if (steps >= 0) {
        call->unlimited = true;
    }
    const size_t limit = set_given(call, structure, full) ? 1 : call->wild ? 5 : 3;
    for (size_t changes = below(limit); changes > 0; changes--) {
        set_member(call, structure, 1 + (int)below((size_t)structure->count - 1), full);
    }
    if (odd(call)) {
        /* A structure of another size, all of which is there. */
        const size_t size = chance(70) ? below(structure->size + 1) : structure->size + below(40);
        const size_t there = size < sizeof size ? sizeof size : size;
        unsigned char *other = room(there, true);
        memset(other, chance(50) ? 0 : 0xee, there);
        memcpy(other, full, there < structure->size ? there : structure->size);
        memcpy(other, &size, sizeof size);
        full = other;
    }
    call->a[argument].pointer = full;
}

static void draw_callback(struct call *call, int argument)
{
    const struct callback *callback = &callbacks[call->function->arguments[argument].of];
    const bool destroys = strcmp(callback->name, "pc_destroy") == 0;
    call->a[argument].function = callback->function;
    /* Data that are to be destroyed were said to be owned, so `destroy` is always given for these. */
    if (!destroys && ((call->function->null && chance(15)) || odd(call))) {
        call->a[argument].function = NULL;
    }
    if (destroys && !(call->user && call->user->owned)) {
        call->a[argument].function = NULL;
    }
}

static void draw_handle(struct call *call, int argument)
{
    const struct argument *is = &call->function->arguments[argument];
    struct entry *entry = call->wild && chance(8) ? NULL : pick(is->of, call->depth);
    if (entry && chance(50)) {
        /* Most calls go on with what was made last. */
        struct entry *last = latest(is->of);
        entry = last && (last->busy == 0 || last == entry) ? last : entry;
    }
    call->entries[argument] = entry;
    call->a[argument].pointer = entry ? entry->handle : NULL;
    if (!call->first || (entry && call->first->dim == 0 && entry->dim > 0)) {
        call->first = entry ? entry : call->first;
    }
}

static void draw_argument(struct call *call, int argument)
{
    const struct argument *is = &call->function->arguments[argument];
    union value *value = &call->a[argument];
    char word[LONGEST_WORD];
    bool null;
    switch (is->kind) {
    case TEXT: draw_one_text(call, argument); break;
    case TEXTS: draw_texts(call, argument); break;
    case BYTES: draw_bytes(call, argument); break;
    case NUMBERS:
    case ROOM: draw_numbers(call, argument); break;
    case OPTIONS: draw_options(call, argument); break;
    case NUMBER: value->number = next_word(call, word, &null) ? strtod(word, NULL) : draw_number(call, is->name); break;
    case COUNT:
        value->count = next_word(call, word, &null) ? (size_t)strtoull(word, NULL, 10) : draw_count(call, is->name);
        break;
    case CHOICE: value->choice = next_word(call, word, &null) ? atoi(word) : draw_choice(call); break;
    case UNSIGNED:
        value->wide = next_word(call, word, &null) ? strtoull(word, NULL, 10) : draw_unsigned(call, is->name);
        break;
    case FREED_TEXT: {
        const size_t at = below(POOL);
        value->pointer = texts[at];
        texts[at] = NULL;
        break;
    }
    case FREED_BYTES: {
        const size_t at = below(POOL);
        value->pointer = blocks[at].data;
        blocks[at].data = NULL;
        break;
    }
    case STRUCTURE: {
        const size_t whole = structures[is->of].size;
        const size_t size = odd(call) ? (chance(70) ? below(whole + 1) : whole + below(40)) : whole;
        value->pointer = odd(call) && chance(20) ? NULL : room(size, false);
        if (value->pointer) {
            memset(value->pointer, 0x77, size);
        }
        call->a[argument + 1].count = size;
        break;
    }
    case TEXT_PLACE:
    case BYTES_PLACE:
    case HANDLE_PLACE:
    case POINTER_PLACE: value->pointer = odd(call) && chance(30) ? NULL : room(sizeof(void *), false); break;
    case PLACE: value->pointer = odd(call) && chance(30) ? NULL : room((size_t)is->of, false); break;
    case ERROR_PLACE: value->pointer = chance(10) ? NULL : room(sizeof(void *), false); break;
    default: break;
    }
}

/* Handles come first, since they say how long arrays are; then numbers that say how many; then the rest. */
void draw_arguments(struct call *call)
{
    const struct function *function = call->function;
    for (int i = 0; i < function->count; i++) {
        if (function->arguments[i].kind == HANDLE || function->arguments[i].kind == FREED_HANDLE) {
            draw_handle(call, i);
        }
    }
    bool destroys = false;
    for (int i = 0; i < function->count; i++) {
        const struct argument *is = &function->arguments[i];
        destroys = destroys || (is->kind == CALLBACK && strcmp(callbacks[is->of].name, "pc_destroy") == 0);
        if (is->kind == COUNT && strcmp(is->name, "count") == 0) {
            call->a[i].count = below(4);
        }
    }
    for (int i = 0; i < function->count; i++) {
        if (function->arguments[i].kind == USER) {
            call->user = chance(10) ? NULL : new_user(destroys && chance(80));
            call->a[i].pointer = call->user;
        }
    }
    for (int i = 0; i < function->count; i++) {
        const struct argument *is = &function->arguments[i];
        if (is->kind == CALLBACK) {
            draw_callback(call, i);
        } else if (!(is->kind == COUNT && strcmp(is->name, "count") == 0)) {
            draw_argument(call, i);
        }
    }
}

static void show_array(const struct call *call, int argument)
{
    const struct argument *is = &call->function->arguments[argument];
    const size_t length = call->lengths[argument];
    if (!call->a[argument].pointer) {
        log_add("NULL");
        return;
    }
    if (is->kind == ROOM && strcmp(is->name, "y") != 0) {
        log_add("%s[%zu]", is->name, length);
        return;
    }
    log_add("{");
    for (size_t i = 0; i < length && i < 12; i++) {
        if (is->real) {
            double number;
            memcpy(&number, (char *)call->a[argument].pointer + i * sizeof number, sizeof number);
            log_add(i > 0 ? ", %.17g" : "%.17g", number);
        } else {
            log_add(i > 0 ? ", %d" : "%d", ((unsigned char *)call->a[argument].pointer)[i * (size_t)is->of]);
        }
    }
    log_add(length > 12 ? ", ... %zu}" : "}", length);
}

static void show_options(const struct call *call, int argument)
{
    const struct structure *structure = &structures[call->function->arguments[argument].of];
    const unsigned char *data = call->a[argument].pointer;
    if (!data) {
        log_add("NULL");
        return;
    }
    size_t size;
    memcpy(&size, data, sizeof size);
    log_add("{size %zu", size);
    for (int i = 1; i < structure->count; i++) {
        const unsigned char *place = data + structure->members[i].place;
        static const size_t sizes[] = { 8, 4, 4, 8, 8, 8, 8, 8, 8 };
        union {
            int choice;
            uint32_t narrow;
            uint64_t wide;
            double number;
        } value;
        const size_t bytes = sizes[structure->members[i].kind];
        if (structure->members[i].place + bytes > size) {
            break;
        }
        memcpy(&value, place, bytes);
        log_add(", %s ", structure->members[i].name);
        switch (structure->members[i].kind) {
        case MEMBER_INT: log_add("%d", value.choice); break;
        case MEMBER_WIDE32: log_add("%u", value.narrow); break;
        case MEMBER_DOUBLE: log_add("%.9g", value.number); break;
        case MEMBER_HANDLE:
        case MEMBER_INTS:
        case MEMBER_DOUBLES: log_add(value.wide ? "given" : "NULL"); break;
        default: log_add("%llu", (unsigned long long)value.wide); break;
        }
    }
    log_add("}");
}

void show_arguments(const struct call *call)
{
    const struct function *function = call->function;
    log_add("%s(", function->name);
    for (int i = 0; i < function->count; i++) {
        const struct argument *is = &function->arguments[i];
        const union value *value = &call->a[i];
        log_add("%s", i > 0 ? ", " : "");
        switch (is->kind) {
        case HANDLE:
        case FREED_HANDLE:
            if (call->entries[i]) {
                log_add("%s_%u", handle_types[is->of].name + 3, call->entries[i]->number);
            } else {
                log_add("NULL");
            }
            break;
        case TEXT:
            if (value->pointer && is->length >= 0) {
                log_add("text of %zu bytes", call->a[is->length].count);
            } else {
                log_text(value->pointer);
            }
            break;
        case TEXTS:
            log_add(value->pointer ? "{" : "NULL");
            for (size_t at = 0; value->pointer && at < call->lengths[i]; at++) {
                log_add("%s", at > 0 ? ", " : "");
                log_text(((char **)value->pointer)[at]);
            }
            log_add("%s", value->pointer ? "}" : "");
            break;
        case NUMBERS:
        case ROOM: show_array(call, i); break;
        case OPTIONS: show_options(call, i); break;
        case NUMBER: log_add("%.17g", value->number); break;
        case LENGTH:
        case SIZE:
        case COUNT: log_add("%zu", value->count); break;
        case CHOICE: log_add("%d", value->choice); break;
        case UNSIGNED: log_add("%llu", (unsigned long long)value->wide); break;
        case CALLBACK: log_add(value->function ? "own_%s" : "NULL", callbacks[is->of].name); break;
        case USER:
            if (call->user) {
                log_add("{good %zu, code %d, way %d}", call->user->good, call->user->code, call->user->way);
            } else {
                log_add("NULL");
            }
            break;
        case BYTES: log_add(value->pointer ? "bytes" : "NULL"); break;
        default: log_add(value->pointer ? "&%s" : "NULL", is->name); break;
        }
    }
    log_add(")");
}
