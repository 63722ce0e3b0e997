/* Functions of the program: they succeed, fail, write nothing or numbers that are not finite, and call the library. */
#include "fuzz.h"

#include <math.h>
#include <pthread.h>
#include <stdatomic.h>

enum { USERS = 128, MAGIC = 0x75736572 };

enum way { WRITES, WRITES_NOTHING, WRITES_NAN, WRITES_LARGE };

static struct user users[USERS];
static size_t user_count;
static pthread_t main_thread;
static int calls_left;

int own_pc_force_function(double t, const double *y, size_t y_length, double *q, size_t q_length, void *data);
int own_pc_force_jacobian(double t, const double *y, size_t y_length, double *dq, size_t dq_length, void *data);
int own_pc_observer(double t, const double *y, size_t y_length, void *data);
int own_pc_event_observer(size_t event, double t, const double *before, const double *after, size_t y_length, void *data);
int own_pc_event_function(double t, const double *y, size_t y_length, double *value, void *data);
int own_pc_event_reset(double t, double *y, size_t y_length, void *data);
int own_pc_member_observer(const pc_member *member, void *data);
void own_pc_destroy(void *data);

void set_up_users(void)
{
    main_thread = pthread_self();
    memset(users, 0, sizeof users);
    user_count = 0;
    calls_left = 30;
}

/* Data for functions; null if there are too many. */
struct user *new_user(bool owned)
{
    if (user_count == USERS) {
        return NULL;
    }
    struct user *user = &users[user_count++];
    user->magic = MAGIC;
    user->owned = owned;
    user->good = chance(60) ? 100000000 : below(30);
    user->code = (int)below(5) - 2;
    user->way = chance(85) ? WRITES : (int)below(4);
    user->nests = chance(40);
    return user;
}

bool users_are_destroyed(void)
{
    for (size_t i = 0; i < user_count; i++) {
        if (users[i].owned && users[i].destroyed != 1) {
            return false;
        }
    }
    return true;
}

static struct user *checked(void *data)
{
    struct user *user = data;
    if (user && (user->magic != MAGIC || (user->owned && user->destroyed > 0))) {
        fall("a function of the program is called with data that were destroyed, or never given");
        return NULL;
    }
    return user;
}

/* What a function of the program returns; on the thread of the program it may call the library before. */
int called(void *data)
{
    struct user *user = checked(data);
    if (!user || !pthread_equal(pthread_self(), main_thread)) {
        return 0;
    }
    const size_t before = user->calls++;
    if (user->nests && depth > 0 && depth < DEEPEST && calls_left > 0 && chance(5)) {
        calls_left--;
        some_call();
    }
    return before < user->good ? 0 : user->code;
}

static bool is_right(bool right)
{
    if (!right) {
        fall("a function of the program is called with a null pointer or a wrong length");
    }
    return right;
}

static void write_numbers(const struct user *user, double *numbers, size_t count, double value)
{
    const int way = user ? user->way : WRITES;
    for (size_t i = 0; i < count && way != WRITES_NOTHING; i++) {
        numbers[i] = way == WRITES_NAN ? NAN : way == WRITES_LARGE ? 1e300 : value;
    }
}

int own_pc_force_function(double t, const double *y, size_t y_length, double *q, size_t q_length, void *data)
{
    const int code = called(data);
    if (!is_right(y_length > 0 && y && (q || q_length == 0)) || code != 0) {
        return code;
    }
    write_numbers(data, q, q_length, cos(t) - y[0]);
    return 0;
}

int own_pc_force_jacobian(double t, const double *y, size_t y_length, double *dq, size_t dq_length, void *data)
{
    (void)t;
    const int code = called(data);
    if (!is_right(y_length > 0 && y && dq && dq_length % y_length == 0) || code != 0) {
        return code;
    }
    write_numbers(data, dq, dq_length, 0.0);
    write_numbers(data, dq, dq_length / y_length, -1.0);
    return 0;
}

int own_pc_observer(double t, const double *y, size_t y_length, void *data)
{
    is_right(isfinite(t) && y && y_length > 0);
    return called(data);
}

int own_pc_event_observer(size_t event, double t, const double *before, const double *after, size_t y_length, void *data)
{
    is_right(event < 100000 && isfinite(t) && before && after && y_length > 0);
    return called(data);
}

int own_pc_event_function(double t, const double *y, size_t y_length, double *value, void *data)
{
    const int code = called(data);
    if (!is_right(y && y_length > 0 && value) || code != 0) {
        return code;
    }
    write_numbers(data, value, 1, sin(5.0 * t) + y[0] / 2.0);
    return 0;
}

int own_pc_event_reset(double t, double *y, size_t y_length, void *data)
{
    (void)t;
    const int code = called(data);
    if (is_right(y && y_length > 0) && code == 0) {
        const struct user *user = data;
        y[y_length - 1] *= -0.9;
        if (user && user->way >= WRITES_NAN) {
            write_numbers(user, y, y_length, 0.0);
        }
    }
    return code;
}

int own_pc_member_observer(const pc_member *member, void *data)
{
    is_right(member && member->dim < 100000);
    const bool good = member->status == PC_OK || member->status == PC_EVENT;
    is_right((member->message == NULL) == good && (member->states == NULL) == (member->rows == 0));
    if (member->status == PC_INTERNAL) {
        fall("a member of an ensemble ends with PC_INTERNAL: %s", member->message);
    }
    return called(data);
}

void own_pc_destroy(void *data)
{
    struct user *user = data;
    if (user && (user->magic != MAGIC || !user->owned || user->destroyed > 0)) {
        fall("data of a function of the program are destroyed that were destroyed, or never given");
        return;
    }
    if (user) {
        user->destroyed++;
    }
}
