/* The last calls as lines, and what is told of a fall: a crash, a hang, or a promise that was broken. */
#define _GNU_SOURCE
#include "fuzz.h"

#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <sys/time.h>
#include <unistd.h>

/* Seconds of processor time that a call may take, and seconds by the clock, after which it waits for something. */
enum { LINES = 64, LENGTH_OF_LINE = 1500, PROCESSOR = 15, CLOCK = 120 };

bool tracing;
bool fallen;

static char lines[LINES][LENGTH_OF_LINE];
static size_t lengths[LINES];
static size_t next_line;
static size_t current;
static char place[256];

/* Signal handlers may write and nothing else. */
static void say(const char *text, size_t length)
{
    while (length > 0) {
        const ssize_t written = write(STDERR_FILENO, text, length);
        if (written <= 0) {
            return;
        }
        text += written;
        length -= (size_t)written;
    }
}

static void tell(const char *what)
{
    say("== fall: ", 9);
    say(what, strlen(what));
    say("\n", 1);
    say(place, strlen(place));
    say("\n", 1);
    for (size_t i = next_line < LINES ? 0 : next_line - LINES; i < next_line; i++) {
        say(lines[i % LINES], lengths[i % LINES]);
        say("\n", 1);
    }
    say("== end of the fall\n", 19);
}

static void on_signal(int number)
{
    switch (number) {
    case SIGPROF: tell("a call takes more than 15 s of processor time"); break;
    case SIGALRM: tell("a call does not come back within 120 s"); break;
    case SIGABRT: tell("the program was aborted"); break;
    case SIGBUS: tell("a bus error"); break;
    case SIGFPE: tell("an arithmetic exception"); break;
    case SIGILL: tell("an illegal instruction"); break;
    default: tell("a segmentation fault"); break;
    }
    count_fall();
    _exit(9);
}

#ifdef SANITIZED
void __sanitizer_set_death_callback(void (*callback)(void));
int __sanitizer_install_malloc_and_free_hooks(void (*malloc_hook)(const volatile void *, size_t),
                                              void (*free_hook)(const volatile void *));

static void on_death(void)
{
    tell("the sanitizers ended the program");
    count_fall();
}

static atomic_long live;

static void allocated(const volatile void *block, size_t bytes)
{
    (void)block;
    (void)bytes;
    atomic_fetch_add_explicit(&live, 1, memory_order_relaxed);
}

static void freed(const volatile void *block)
{
    if (block) {
        atomic_fetch_sub_explicit(&live, 1, memory_order_relaxed);
    }
}
#elif !defined(__GLIBC__)
static atomic_long live;
#else
/* The allocator of glibc, counted. */
void *__libc_malloc(size_t bytes);
void *__libc_calloc(size_t count, size_t bytes);
void *__libc_realloc(void *block, size_t bytes);
void *__libc_memalign(size_t alignment, size_t bytes);
void __libc_free(void *block);

static atomic_long live;

static void *counted(void *block)
{
    atomic_fetch_add_explicit(&live, block != NULL, memory_order_relaxed);
    return block;
}

void *malloc(size_t bytes)
{
    return counted(__libc_malloc(bytes));
}

void *calloc(size_t count, size_t bytes)
{
    return counted(__libc_calloc(count, bytes));
}

void *realloc(void *block, size_t bytes)
{
    void *moved = __libc_realloc(block, bytes);
    atomic_fetch_add_explicit(&live, (!block && moved) - (block && bytes == 0), memory_order_relaxed);
    return moved;
}

void *aligned_alloc(size_t alignment, size_t bytes)
{
    return counted(__libc_memalign(alignment, bytes));
}

void *memalign(size_t alignment, size_t bytes)
{
    return counted(__libc_memalign(alignment, bytes));
}

int posix_memalign(void **block, size_t alignment, size_t bytes)
{
    *block = counted(__libc_memalign(alignment, bytes));
    return *block ? 0 : 12;
}

void free(void *block)
{
    atomic_fetch_sub_explicit(&live, block != NULL, memory_order_relaxed);
    __libc_free(block);
}
#endif

long live_blocks(void)
{
    return atomic_load(&live);
}

void set_up_log(uint64_t seed, const char *replay)
{
    snprintf(place, sizeof place, "%s%llu:", replay, (unsigned long long)seed);
    static char stack[1 << 16];
    const stack_t own = { .ss_sp = stack, .ss_size = sizeof stack };
    sigaltstack(&own, NULL);
    struct sigaction action;
    memset(&action, 0, sizeof action);
    action.sa_handler = on_signal;
    action.sa_flags = SA_ONSTACK | (int)SA_RESETHAND;
    const int always[] = { SIGPROF, SIGALRM, SIGABRT };
    for (size_t i = 0; i < 3; i++) {
        sigaction(always[i], &action, NULL);
    }
#ifdef SANITIZED
    __sanitizer_set_death_callback(on_death);
    __sanitizer_install_malloc_and_free_hooks(allocated, freed);
#else
    const int crashes[] = { SIGSEGV, SIGBUS, SIGILL, SIGFPE };
    for (size_t i = 0; i < 4; i++) {
        sigaction(crashes[i], &action, NULL);
    }
#endif
}

void log_sequence(uint64_t number)
{
    char *colon = strrchr(place, ':');
    snprintf(colon, (size_t)(place + sizeof place - colon), ":%llu", (unsigned long long)number);
    next_line = 0;
}

size_t log_begin(int depth_of_call)
{
    current = next_line++;
    lengths[current % LINES] = 0;
    for (int i = 0; i < depth_of_call; i++) {
        log_add("    ");
    }
    return current;
}

static void append(size_t line, const char *format, va_list values)
{
    char *start = lines[line % LINES];
    size_t *length = &lengths[line % LINES];
    const size_t left = LENGTH_OF_LINE - *length;
    const int written = vsnprintf(start + *length, left, format, values);
    *length += written < 0 ? 0 : (size_t)written < left ? (size_t)written : left - 1;
}

void log_add(const char *format, ...)
{
    va_list values;
    va_start(values, format);
    append(current, format, values);
    va_end(values);
}

/* A text as C writes it, cut short. */
void log_text(const char *text)
{
    if (!text) {
        log_add("NULL");
        return;
    }
    const size_t length = strlen(text);
    log_add("\"");
    for (size_t i = 0; i < length && i < 120; i++) {
        const unsigned char c = (unsigned char)text[i];
        if (c == '"' || c == '\\') {
            log_add("\\%c", c);
        } else if (c < 32 || c == 127) {
            log_add("\\%03o", c);
        } else {
            log_add("%c", c);
        }
    }
    if (length > 120) {
        log_add("...\" of %zu bytes", length);
    } else {
        log_add("\"");
    }
}

void log_append(size_t line, const char *format, ...)
{
    if (next_line - line > LINES) {
        return;
    }
    va_list values;
    va_start(values, format);
    append(line, format, values);
    va_end(values);
}

void log_show(size_t line)
{
    if (tracing && next_line - line <= LINES) {
        fprintf(stderr, "%.*s\n", (int)lengths[line % LINES], lines[line % LINES]);
    }
}

void fall(const char *format, ...)
{
    static char what[2000];
    va_list values;
    va_start(values, format);
    vsnprintf(what, sizeof what, format, values);
    va_end(values);
    tell(what);
    count_fall();
    fallen = true;
}

static void set_clocks(long processor, long clock_)
{
    const struct itimerval of_processor = { .it_value = { .tv_sec = processor } };
    const struct itimerval of_clock = { .it_value = { .tv_sec = clock_ } };
    setitimer(ITIMER_PROF, &of_processor, NULL);
    setitimer(ITIMER_REAL, &of_clock, NULL);
}

void clock_start(void)
{
    set_clocks(PROCESSOR, CLOCK);
}

void clock_stop(void)
{
    set_clocks(0, 0);
}
