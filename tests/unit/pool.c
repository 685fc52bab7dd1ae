/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Work on the cores: everything is done once, taken in order, and never more of it begun than there is room
   for. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "app/base/pool.h"

enum { PIECES = 2000, WINDOW = 7 };

struct count {
    atomic_size_t begun;
    size_t slots[WINDOW], taken, enough;
    size_t done[PIECES];
};

static void work(void *self, size_t index, size_t slot)
{
    struct count *count = self;
    atomic_fetch_add(&count->begun, 1);
    for (volatile size_t i = 0; i < (index % 13) * 100; i++) { /* later pieces overtake earlier ones */
    }
    count->done[index]++;
    count->slots[slot] = index;
}

static bool take(void *self, size_t index, size_t slot)
{
    struct count *count = self;
    assert_int_equal(index, count->taken);
    assert_int_equal(count->slots[slot], index);
    assert_true(atomic_load(&count->begun) <= index + WINDOW);
    if (index == count->enough) {
        return false;
    }
    count->taken++;
    return true;
}

static bool has_begun_many(void *self)
{
    return atomic_load(&((struct count *)self)->begun) >= 1000;
}

static void everything_is_taken_in_order(void **state)
{
    (void)state;
    /* also with more threads than pieces can be begun: those that wait find the end */
    for (size_t jobs = 0; jobs < 4 * WINDOW; jobs += jobs < 5 ? 1 : WINDOW) {
        struct count count = {.enough = PIECES};
        const struct gm_pool pool = {
            .count = PIECES, .jobs = jobs, .window = WINDOW, .work = work, .take = take, .self = &count};
        assert_int_equal(gm_pool_run(&pool), PIECES);
        for (size_t i = 0; i < PIECES; i++) {
            assert_int_equal(count.done[i], 1);
        }
    }
}

static void it_ends_early(void **state)
{
    (void)state;
    for (size_t jobs = 1; jobs < 6; jobs += 2) {
        struct count refused = {.enough = 100}, stopped = {.enough = PIECES};
        struct gm_pool pool = {
            .count = PIECES, .jobs = jobs, .window = WINDOW, .work = work, .take = take, .self = &refused};
        assert_int_equal(gm_pool_run(&pool), 100);
        pool.self = &stopped;
        pool.stopped = has_begun_many;
        const size_t taken = gm_pool_run(&pool);
        assert_true(taken == atomic_load(&stopped.begun) && taken >= 1000 && taken < 1000 + WINDOW);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(everything_is_taken_in_order),
        cmocka_unit_test(it_ends_early),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
