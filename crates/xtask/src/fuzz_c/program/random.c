/* Random numbers: splitmix64. */
#include "fuzz.h"

static uint64_t state;

uint64_t draw(void)
{
    uint64_t z = state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

void seed_random(uint64_t seed, uint64_t number)
{
    state = seed;
    state = draw() ^ (number * 0xd1342543de82ef95u);
    draw();
}

size_t below(size_t count)
{
    return count == 0 ? 0 : (size_t)(draw() % count);
}

bool chance(unsigned percent)
{
    return below(100) < percent;
}

double between(double from, double to)
{
    return from + (to - from) * ((double)(draw() >> 11) / 9007199254740992.0);
}
