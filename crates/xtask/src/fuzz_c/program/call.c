/* One call, and what the header promises of it. */
#include "fuzz.h"

#include <math.h>

int depth;

/* What places hold before a call; the library must not look at it. */
static void *const poison = (void *)(uintptr_t)0x5ca1ab1e5ca1ab1e;

static bool is_silent(int status)
{
    return status == PC_OK || status == PC_STOPPED || status == PC_EVENT;
}

static bool is_utf8(const char *text)
{
    for (const unsigned char *c = (const unsigned char *)text; *c;) {
        const int more = *c < 0x80 ? 0 : *c >= 0xc2 && *c < 0xe0 ? 1 : *c >= 0xe0 && *c < 0xf0 ? 2 : *c >= 0xf0 && *c < 0xf5 ? 3 : -1;
        if (more < 0) {
            return false;
        }
        c++;
        for (int i = 0; i < more; i++, c++) {
            if ((*c & 0xc0) != 0x80) {
                return false;
            }
        }
    }
    return true;
}

static void *pointer_at(const void *place)
{
    void *pointer;
    memcpy(&pointer, place, sizeof pointer);
    return pointer;
}

static void poison_places(const struct call *call)
{
    for (int i = 0; i < call->function->count; i++) {
        const struct argument *is = &call->function->arguments[i];
        if (!call->a[i].pointer) {
            continue;
        }
        switch (is->kind) {
        case HANDLE_PLACE:
        case TEXT_PLACE:
        case BYTES_PLACE:
        case POINTER_PLACE:
        case ERROR_PLACE: memcpy(call->a[i].pointer, &poison, sizeof poison); break;
        case PLACE: memset(call->a[i].pointer, 0xff, (size_t)is->of); break;
        default: break;
        }
    }
}

static void use_handles(const struct call *call, int change)
{
    for (int i = 0; i < call->function->count; i++) {
        if (call->entries[i]) {
            call->entries[i]->busy += change;
        }
    }
}

/* The names that go with a new handle. */
static void harvest(int type, void *handle)
{
    for (size_t i = 0; i < function_count; i++) {
        const struct function *function = &functions[i];
        if (function->result != NAME || function->counted < 0 || function->count != 2 || function->arguments[0].of != type ||
            function->arguments[0].kind != HANDLE) {
            continue;
        }
        union value a[ARGUMENTS] = { { .pointer = handle } }, r;
        functions[function->counted].call(a, &r);
        const size_t count = r.count < 6 ? r.count : 6;
        for (a[1].count = 0; a[1].count < count; a[1].count++) {
            function->call(a, &r);
            remember_name(r.pointer);
        }
    }
}

static void look_at_time(struct entry *entry, int type)
{
    const char *name = handle_types[type].name;
    if (strcmp(name, "pc_solver") == 0) {
        double t;
        entry->t = pc_solver_time(entry->handle, &t, NULL) == PC_OK ? t : entry->t;
    } else if (strcmp(name, "pc_dense") == 0) {
        entry->t = pc_dense_t_begin(entry->handle);
        entry->span = pc_dense_t_end(entry->handle) - entry->t;
    }
}

static void learn_of_handle(struct entry *entry, int type, const struct call *call)
{
    const struct entry *parent = call->first;
    if (handle_types[type].dim >= 0) {
        union value a[ARGUMENTS] = { { .pointer = entry->handle } }, r;
        functions[handle_types[type].dim].call(a, &r);
        entry->dim = r.count;
    } else if (parent) {
        entry->dim = parent->dim;
    }
    entry->unlimited = call->unlimited;
    if (strcmp(handle_types[type].name, "pc_system") == 0 && entry->dim <= 64) {
        entry->has_start = pc_system_start(entry->handle, &entry->t, entry->start, entry->dim, NULL) == PC_OK;
    } else if (parent && parent->dim == entry->dim) {
        entry->has_start = parent->has_start;
        memcpy(entry->start, parent->start, sizeof entry->start);
        entry->t = parent->t;
    }
    look_at_time(entry, type);
    harvest(type, entry->handle);
}

/* Keeps a new handle, for which room is made. */
static void keep(int type, void *handle, const struct call *call)
{
    struct entry *entry = vacant(type);
    if (!entry) {
        struct entry *old = NULL;
        for (int i = 0; i < POOL; i++) {
            struct entry *other = pools[type][i];
            old = other->busy == 0 && (!old || chance(50)) ? other : old;
        }
        if (!old) {
            struct entry alone = { .handle = handle };
            free_entry(type, &alone);
            return;
        }
        free_entry(type, old);
        entry = vacant(type);
    }
    entry->handle = handle;
    learn_of_handle(entry, type, call);
    log_append(call->line, " %s_%u", handle_types[type].name + 3, entry->number);
}

static void check_error(const struct call *call, int status, pc_error *error)
{
    const char *name = call->function->name;
    if (is_silent(status)) {
        if (error) {
            fall("%s succeeds and writes an error", name);
        }
        return;
    }
    if (!error || error == poison) {
        fall("%s fails with %s and writes no error", name, pc_status_name(status));
        return;
    }
    const char *message = pc_error_message(error);
    const bool by_integrator = status == PC_INTEGRATION || status == PC_INVALID_ARGUMENT;
    if ((int)pc_error_status(error) != status) {
        fall("%s fails with %s and its error says %s", name, pc_status_name(status), pc_status_name((int)pc_error_status(error)));
    } else if (!message || !*message || !is_utf8(message)) {
        fall("%s fails without a message", name);
    } else if ((pc_error_line(error) > 0) != (pc_error_column(error) > 0)) {
        fall("%s fails at line %zu, column %zu", name, pc_error_line(error), pc_error_column(error));
    } else if (pc_error_offset(error) + pc_error_length(error) > 0 && pc_error_line(error) == 0) {
        fall("%s fails at byte %zu without a line", name, pc_error_offset(error));
    } else if (pc_error_is_recoverable(error) != 0 && status != PC_EVALUATION) {
        fall("%s fails with %s, which is said to be recoverable", name, pc_status_name(status));
    } else if (pc_error_integrator_code(error) != 0 && !by_integrator) {
        fall("%s fails with %s and a code of the integrator", name, pc_status_name(status));
    }
}

/* Takes over or frees what a call has written, once it is known to be right. */
static void take_results(const struct call *call, int status, char *message, size_t room_of_message)
{
    const struct function *function = call->function;
    const bool silent = is_silent(status);
    for (int i = 0; i < function->count; i++) {
        const struct argument *is = &function->arguments[i];
        void *place = call->a[i].pointer;
        if (!place || is->kind < HANDLE_PLACE || is->kind > POINTER_PLACE) {
            continue;
        }
        if (is->kind == ERROR_PLACE) {
            pc_error *error = pointer_at(place);
            check_error(call, status, error);
            if (error && error != poison) {
                snprintf(message, room_of_message, "%s", pc_error_message(error));
                if (chance(10)) {
                    keep(handle_type("pc_error"), error, call);
                } else {
                    pc_error_free(error);
                }
            }
            continue;
        }
        if (is->kind != HANDLE_PLACE && is->kind != TEXT_PLACE && is->kind != BYTES_PLACE) {
            continue;
        }
        void *result = pointer_at(place);
        if (result == poison) {
            if (silent) {
                fall("%s succeeds and does not write `%s`", function->name, is->name);
            } else if (is->kind != BYTES_PLACE) {
                fall("%s fails with %s and does not write NULL to `%s`", function->name, pc_status_name(status), is->name);
            }
            continue;
        }
        if ((result == NULL && status == PC_OK) || (result != NULL && !silent)) {
            fall("%s ends with %s and `%s` is %s", function->name, pc_status_name(status), is->name, result ? "not NULL" : "NULL");
        }
        if (!result) {
            continue;
        }
        if (is->kind == HANDLE_PLACE) {
            keep(is->of, result, call);
        } else if (is->kind == TEXT_PLACE) {
            if (!is_utf8(result)) {
                fall("%s writes a text that is not UTF-8", function->name);
            }
            char **other = &texts[below(POOL)];
            if (chance(30) && !*other) {
                *other = result;
            } else {
                pc_string_free(result);
            }
        } else {
            size_t length = 0;
            memcpy(&length, call->a[i + 1].pointer, sizeof length);
            struct bytes *block = &blocks[below(POOL)];
            pc_bytes_free(block->data);
            block->data = result;
            block->length = length;
        }
    }
}

static bool is_moderate_number(double number)
{
    return number == 0.0 || (fabs(number) > 1e-60 && fabs(number) < 1e60);
}

/* Whether all numbers that a call is given are of a size at which results can be finite. */
static bool is_moderate(const struct call *call)
{
    for (int i = 0; i < call->function->count; i++) {
        const struct argument *is = &call->function->arguments[i];
        if (is->kind == NUMBER && !is_moderate_number(call->a[i].number)) {
            return false;
        }
        for (size_t at = 0; is->real && (is->kind == NUMBERS || is->kind == ROOM) && call->a[i].pointer && at < call->lengths[i]; at++) {
            double number;
            memcpy(&number, (char *)call->a[i].pointer + at * sizeof number, sizeof number);
            if (!is_moderate_number(number)) {
                return false;
            }
        }
    }
    return true;
}

static void check_numbers(const struct call *call)
{
    const struct function *function = call->function;
    if (!call->moderate || function->infinite) {
        return;
    }
    for (int i = 0; i < function->count; i++) {
        const struct argument *is = &function->arguments[i];
        if (!is->real || !call->a[i].pointer || (is->kind != ROOM && is->kind != PLACE)) {
            continue;
        }
        const size_t length = is->kind == PLACE ? 1 : call->lengths[i];
        for (size_t at = 0; at < length; at++) {
            double number;
            memcpy(&number, (char *)call->a[i].pointer + at * sizeof number, sizeof number);
            if (!isfinite(number)) {
                fall("%s succeeds and %s[%zu] is %g", function->name, is->name, at, number);
                return;
            }
        }
    }
}

/* Whether a handle that the call needs is null. */
static bool lacks_handle(const struct call *call)
{
    for (int i = 0; i < call->function->count; i++) {
        if (call->function->arguments[i].kind == HANDLE && !call->a[i].pointer) {
            return true;
        }
    }
    return false;
}

static bool check_name(const struct call *call, const char *name)
{
    const struct function *function = call->function;
    if (name && !is_utf8(name)) {
        fall("%s gives a text that is not UTF-8", function->name);
    }
    if (function->counted < 0) {
        if (!name) {
            fall("%s gives NULL", function->name);
        }
        return true;
    }
    union value r;
    functions[function->counted].call(call->a, &r);
    const size_t index = call->a[function->count - 1].count;
    if ((name != NULL) != (index < r.count)) {
        fall("%s gives %s for %zu of %zu", function->name, name ? "a name" : "NULL", index, r.count);
    }
    remember_name(name);
    return name != NULL;
}

static bool has_state_of_handle(const struct function *function)
{
    for (int i = 0; i < function->count; i++) {
        if (function->arguments[i].power > 0) {
            return true;
        }
    }
    return false;
}

/* What a result other than a status is to be; whether the call did something. */
static bool check_result(const struct call *call, const union value *r)
{
    const struct function *function = call->function;
    const bool lacks = lacks_handle(call);
    switch (function->result) {
    case NAME: return check_name(call, r->pointer) && !lacks;
    case SOME:
        if (lacks && r->count != 0) {
            fall("%s of NULL is %zu", function->name, r->count);
        }
        break;
    case REAL:
        if (lacks && !isnan(r->number)) {
            fall("%s of NULL is %g", function->name, r->number);
        }
        break;
    case WHOLE:
        if (has_state_of_handle(function)) {
            if (r->choice < -1 || r->choice > 1) {
                fall("%s returns %d", function->name, r->choice);
            } else if (r->choice == 0) {
                check_numbers(call);
            }
            return r->choice == 0;
        }
        break;
    default: break;
    }
    return !lacks;
}

/* Whether another array has the same length. */
static bool shares_length(const struct function *function, int argument)
{
    for (int i = 0; i < function->count; i++) {
        if (i != argument && function->arguments[i].length == function->arguments[argument].length) {
            return true;
        }
    }
    return false;
}

/* Learns from a message how long an array must be: `y: 3 numbers instead of 4`; the number of the array, or -1. */
static int learn_length(const struct call *call, const char *message, size_t *length)
{
    const char *said = strstr(message, " numbers instead of ");
    const char *colon = said ? strchr(message, ':') : NULL;
    if (!said || !colon || colon > said) {
        return -1;
    }
    const size_t found = (size_t)strtoull(colon + 1, NULL, 10);
    *length = (size_t)strtoull(said + strlen(" numbers instead of "), NULL, 10);
    int best = -1;
    for (int i = 0; i < call->function->count; i++) {
        const struct argument *is = &call->function->arguments[i];
        if ((is->kind != NUMBERS && is->kind != ROOM) || is->length < 0 || is->power > 0 || call->a[is->length].count != found ||
            shares_length(call->function, i)) {
            continue;
        }
        const bool named = strncmp(message, is->name, (size_t)(colon - message)) == 0 && is->name[colon - message] == '\0';
        if (best < 0 || named) {
            best = i;
        }
    }
    return best;
}

/* Makes the call once. */
static enum outcome perform(struct call *call, size_t mark, char *message, size_t room_of_message)
{
    const struct function *function = call->function;
    union value r;
    memset(&r, 0, sizeof r);
    *message = '\0';
    call->moderate = is_moderate(call);
    poison_places(call);
    room_seal(mark);
    const size_t line = call->line = log_begin(depth);
    show_arguments(call);
    use_handles(call, 1);
    depth++;
    clock_start();
    const uint64_t start = now();
    function->call(call->a, &r);
    const uint64_t took = now() - start;
    depth--;
    use_handles(call, -1);
    if (depth > 0) {
        clock_start();
    } else {
        clock_stop();
    }
    if (!room_untouched(mark)) {
        fall("%s writes to what it is only to read, or before an array", function->name);
    }
    bool succeeded;
    if (function->result == STATUS) {
        bool known = false;
        for (size_t i = 0; i < status_count; i++) {
            known = known || statuses[i] == r.choice;
        }
        succeeded = is_silent(r.choice);
        log_append(line, " = %s in %.3f ms", pc_status_name(r.choice), (double)took / 1e6);
        if (!known) {
            fall("%s returns %d", function->name, r.choice);
        }
        take_results(call, r.choice, message, room_of_message);
        if (*message) {
            log_append(line, "; %.300s", message);
        }
        if (r.choice == PC_INTERNAL || r.choice == PC_DISAGREEMENT) {
            fall("%s returns %s: %s", function->name, pc_status_name(r.choice), message);
        }
        if (succeeded) {
            check_numbers(call);
        }
    } else {
        succeeded = check_result(call, &r);
        switch (function->result) {
        case NAME: log_append(line, " = %.100s", r.pointer ? (const char *)r.pointer : "NULL"); break;
        case WHOLE: log_append(line, " = %d", r.choice); break;
        case REAL: log_append(line, " = %.17g", r.number); break;
        case NOTHING: log_append(line, ";"); break;
        default: log_append(line, " = %zu", r.count); break;
        }
    }
    log_show(line);
    if (call->overlaps && succeeded) {
        fall("%s takes arrays that overlap", function->name);
    }
    if (call->damaged && succeeded) {
        fall("%s takes bytes that were changed", function->name);
    }
    for (int i = 0; i < function->count; i++) {
        struct entry *entry = call->entries[i];
        if (!entry) {
            continue;
        }
        if (function->arguments[i].kind == FREED_HANDLE && entry->busy == 0) {
            entry->handle = NULL;
        } else if (entry->handle && entry->busy == 0) {
            look_at_time(entry, function->arguments[i].of);
        }
    }
    count_call((size_t)call->number, succeeded, took);
    return succeeded ? SUCCEEDED : FAILED;
}

enum outcome make(int number, const char *given, bool wild)
{
    struct call call;
    memset(&call, 0, sizeof call);
    call.function = &functions[number];
    call.number = number;
    call.depth = depth;
    call.wild = wild;
    call.given = given;
    const size_t mark = room_mark();
    draw_arguments(&call);
    char message[2000];
    enum outcome outcome = perform(&call, mark, message, sizeof message);
    /* Lengths that the library asks for are learned, and the call is made again. */
    for (int again = 0; again < 5 && outcome == FAILED && !fallen && !call.user && !call.overlaps; again++) {
        size_t length = 0;
        const int array = learn_length(&call, message, &length);
        if (array < 0 || length > (ROOM_BYTES - PAGE) / 8) {
            break;
        }
        if (call.first) {
            call.first->learned[number][array] = (uint16_t)(length + 1);
        }
        if (chance(10)) {
            break;
        }
        draw_array(&call, array, length);
        outcome = perform(&call, mark, message, sizeof message);
    }
    room_release(mark);
    return outcome;
}

enum outcome make_named(const char *function, const char *given, bool wild)
{
    return make(function_named(function), given, wild);
}

void free_entry(int type, struct entry *entry)
{
    if (handle_types[type].free < 0) {
        fprintf(stderr, "there is no function that frees a %s\n", handle_types[type].name);
        exit(2);
    }
    struct call call;
    memset(&call, 0, sizeof call);
    call.number = handle_types[type].free;
    call.function = &functions[call.number];
    call.entries[0] = entry;
    call.a[0].pointer = entry->handle;
    char message[8];
    const size_t mark = room_mark();
    perform(&call, mark, message, sizeof message);
    room_release(mark);
}
