/* What was called and what succeeded, in a file in memory: whoever started the program reads it, also after a crash. */
#include "fuzz.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <time.h>
#include <unistd.h>

/* The calls, the successes, the falls, the sequence at work, whether all is done, the sequences; then of each function the calls,
   the successes, the nanoseconds and those of the longest call. */
enum { HEAD = 8, EACH = 4 };

static uint64_t *counts;

void set_up_counts(const char *path)
{
    const size_t bytes = (HEAD + EACH * function_count) * sizeof(uint64_t);
    const int file = open(path, O_RDWR | O_CREAT, 0666);
    if (file < 0 || ftruncate(file, (off_t)bytes) != 0) {
        perror(path);
        exit(2);
    }
    counts = mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    close(file);
    if (counts == MAP_FAILED) {
        perror(path);
        exit(2);
    }
}

void count_call(size_t function, bool succeeded, uint64_t nanoseconds)
{
    uint64_t *of = counts + HEAD + EACH * function;
    counts[0]++;
    counts[1] += succeeded;
    of[0]++;
    of[1] += succeeded;
    of[2] += nanoseconds;
    of[3] = nanoseconds > of[3] ? nanoseconds : of[3];
}

void count_fall(void)
{
    counts[2]++;
}

void count_sequence(uint64_t number)
{
    counts[3] = number;
    counts[5]++;
}

void count_end(void)
{
    counts[4] = 1;
}

uint64_t calls_so_far(void)
{
    return counts[0];
}

uint64_t now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (uint64_t)time.tv_sec * 1000000000u + (uint64_t)time.tv_nsec;
}
