/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Arenas: what they close and in which order, what leaves a body, and blocks that change their size. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <wchar.h>
/* cmocka needs those above */
#include <cmocka.h>

#include "core/arena.h"
#include "core/basics.h"

static char closed[8];

static void note(void *thing)
{
    const size_t length = strlen(closed);
    closed[length] = *(char *)thing;
    closed[length + 1] = 0;
}

static void keep_three(struct gm_arena *arena, void *data)
{
    char *letters = data;
    for (int i = 0; i < 3; i++) {
        gm_arena_keep(arena, letters + i, note);
        memset(gm_arena_take(arena, 100, 1), 'x', 100);
    }
    if (letters[3] == '!') {
        gm_arena_refuse(arena, "there is no %d", 4);
    }
    if (letters[3] == '-') {
        gm_arena_leave(arena);
    }
}

static void test_closes_the_last_first(void **state)
{
    (void)state;
    closed[0] = 0;
    struct gm_arena *arena = gm_arena_open();
    assert_true(gm_arena_run(arena, keep_three, "abc"));
    assert_string_equal(closed, "");
    gm_arena_close(arena);
    assert_string_equal(closed, "cba");
}

static void test_a_refusal_closes_what_the_body_took(void **state)
{
    (void)state;
    closed[0] = 0;
    struct gm_arena *arena = gm_arena_open();
    gm_arena_keep(arena, "z", note);
    assert_false(gm_arena_run(arena, keep_three, "abc!"));
    assert_string_equal(gm_arena_reason(arena), "there is no 4");
    assert_string_equal(closed, "cba");
    assert_false(gm_arena_run(arena, keep_three, "d  -"));
    gm_arena_close(arena);
    assert_string_equal(closed, "cba  dz");
}

static void test_a_body_makes_an_arena_or_nothing(void **state)
{
    (void)state;
    closed[0] = 0;
    struct gm_arena *arena = gm_arena_made(keep_three, "abc");
    assert_non_null(arena);
    assert_string_equal(closed, "");
    gm_arena_close(arena);
    assert_string_equal(closed, "cba");
    closed[0] = 0;
    assert_null(gm_arena_made(keep_three, "abc-"));
    assert_string_equal(closed, "cba");
}

static void test_a_thing_goes_before_the_others(void **state)
{
    (void)state;
    for (size_t i = 0; i < 3; i++) {
        char letters[] = "abc";
        struct gm_arena *arena = gm_arena_open();
        closed[0] = 0;
        assert_true(gm_arena_run(arena, keep_three, letters));
        gm_arena_drop(arena, letters + i);
        assert_int_equal(closed[0], letters[i]);
        gm_arena_close(arena);
        assert_string_equal(closed + 1, ((const char *[]){"cb", "ca", "ba"})[i]);
    }
}

static void grow(struct gm_arena *arena, void *data)
{
    uint64_t *numbers = NULL;
    for (size_t count = 1; count <= 1000; count *= 10) {
        numbers = gm_arena_resize(arena, numbers, count, sizeof *numbers);
        numbers[count - 1] = count;
        char *between = gm_arena_take(arena, 16, 1); /* the block is no longer the last */
        for (int i = 0; i < 16; i++) {
            assert_int_equal(between[i], 0);
        }
    }
    *(uint64_t *)data = numbers[0] + numbers[9] + numbers[99] + numbers[999];
}

static void test_blocks_grow(void **state)
{
    (void)state;
    uint64_t sum = 0;
    struct gm_arena *arena = gm_arena_open();
    assert_true(gm_arena_run(arena, grow, &sum));
    assert_int_equal(sum, 1111);
    gm_arena_close(arena);
}

static void take_too_much(struct gm_arena *arena, void *data)
{
    size_t *count = data;
    gm_arena_take(arena, *count, 8);
    *count = 0; /* not reached */
}

static void test_refused_memory_leaves_the_body(void **state)
{
    (void)state;
    static const size_t counts[] = {SIZE_MAX, SIZE_MAX / 8};
    for (size_t i = 0; i < GM_COUNT(counts); i++) {
        size_t count = counts[i];
        struct gm_arena *arena = gm_arena_open();
        assert_false(gm_arena_run(arena, take_too_much, &count));
        assert_int_equal(count, counts[i]);
        assert_string_equal(gm_arena_reason(arena), "not enough memory");
        assert_null(gm_arena_take(arena, count, 8)); /* outside of a body */
        gm_arena_close(arena);
    }
    assert_false(gm_arena_run(NULL, take_too_much, NULL));
    assert_string_equal(gm_arena_reason(NULL), "not enough memory");
}

static void print_and_need(struct gm_arena *arena, void *data)
{
    char **text = data;
    *text = gm_arena_print(arena, "%s, %d", "a text", 7);
    gm_arena_need(arena, true);
    assert_string_equal(*text, "a text, 7");
    gm_arena_need(arena, false);
    *text = NULL; /* not reached */
}

static void test_texts_and_what_others_take(void **state)
{
    (void)state;
    char *text = NULL;
    struct gm_arena *arena = gm_arena_open();
    assert_false(gm_arena_run(arena, print_and_need, &text));
    assert_non_null(text);
    assert_string_equal(gm_arena_reason(arena), "not enough memory");
    gm_arena_close(arena);
}

static void test_scratch_goes_before_the_rest(void **state)
{
    (void)state;
    closed[0] = 0;
    struct gm_arena *arena = gm_arena_open();
    gm_arena_keep(arena, "a", note);
    const size_t mark = gm_arena_mark(arena);
    gm_arena_keep(arena, "b", note);
    assert_non_null(gm_arena_take(arena, 5, 5));
    gm_arena_release(arena, mark);
    assert_string_equal(closed, "b");
    gm_arena_close(arena);
    assert_string_equal(closed, "ba");
}

/* The last block before the mark grows, and moves in memory; so may one behind it. */
static void test_a_mark_outlasts_blocks_that_grow(void **state)
{
    (void)state;
    static char b[] = "b";
    for (size_t count = 10; count <= 1000000; count *= 100) {
        closed[0] = 0;
        struct gm_arena *arena = gm_arena_open();
        gm_arena_keep(arena, "a", note);
        uint64_t *numbers = gm_arena_take(arena, 1, sizeof *numbers);
        const size_t mark = gm_arena_mark(arena);
        gm_arena_keep(arena, b, note);
        numbers = gm_arena_resize(arena, numbers, count, sizeof *numbers);
        gm_arena_keep(arena, "c", note);
        gm_arena_drop(arena, b);
        gm_arena_release(arena, mark);
        assert_string_equal(closed, "bc");
        numbers[count - 1] = count; /* still there */
        gm_arena_release(arena, mark);
        assert_string_equal(closed, "bc");
        gm_arena_close(arena);
        assert_string_equal(closed, "bca");
    }
}

static void print_no_letter(struct gm_arena *arena, void *data)
{
    gm_arena_print(arena, "%lc", (wint_t)0x20ac); /* the locale C has no such letter */
    *(bool *)data = true;                         /* not reached */
}

static void test_what_has_no_letters_is_refused(void **state)
{
    (void)state;
    bool printed = false;
    struct gm_arena *arena = gm_arena_open();
    assert_false(gm_arena_run(arena, print_no_letter, &printed));
    assert_false(printed);
    assert_null(gm_arena_print(arena, "%lc", (wint_t)0x20ac)); /* outside of a body */
    gm_arena_close(arena);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_closes_the_last_first),
        cmocka_unit_test(test_a_refusal_closes_what_the_body_took),
        cmocka_unit_test(test_a_body_makes_an_arena_or_nothing),
        cmocka_unit_test(test_blocks_grow),
        cmocka_unit_test(test_refused_memory_leaves_the_body),
        cmocka_unit_test(test_a_thing_goes_before_the_others),
        cmocka_unit_test(test_texts_and_what_others_take),
        cmocka_unit_test(test_scratch_goes_before_the_rest),
        cmocka_unit_test(test_a_mark_outlasts_blocks_that_grow),
        cmocka_unit_test(test_what_has_no_letters_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
