/* SPDX-License-Identifier: GPL-3.0-or-later */
/* libgeomint as a program of somebody else's sees it: refusals, numbers, threads, and that the host stays as
   it was. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <geomint.h>
#include <gsl/gsl_errno.h>
#include <limits.h>
#include <locale.h>
#include <math.h>
#include <pthread.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#define OPEN(...)                                                                                            \
    geomint_open(sizeof((const char *[]){__VA_ARGS__}) / sizeof(char *), (const char *[]){__VA_ARGS__})

static void expect_refusal(geomint *handle, int status, const char *part)
{
    assert_non_null(handle);
    assert_int_equal(geomint_status(handle), status);
    assert_int_equal(geomint_lanes(handle), 0);
    if (!strstr(geomint_message(handle), part)) {
        fail_msg("\"%s\" does not say \"%s\"", geomint_message(handle), part);
    }
    assert_null(geomint_text(handle));
    assert_null(geomint_state(handle, 0, NULL, NULL));
    assert_int_equal(geomint_step(handle, 0, 1), GEOMINT_USAGE);
    geomint_close(handle);
}

static void test_refusals(void **state)
{
    (void)state;
    expect_refusal(geomint_open(0, NULL), GEOMINT_USAGE, "which scene");
    expect_refusal(OPEN("keplr"), GEOMINT_USAGE, "kepler");
    expect_refusal(OPEN("kepler", "eccentrcity=0.5"), GEOMINT_USAGE, "eccentricity");
    expect_refusal(OPEN("kepler", "scheme=verlett"), GEOMINT_USAGE, "verlet");
    expect_refusal(OPEN("kepler", "dt=zero"), GEOMINT_USAGE, "zero");
    expect_refusal(OPEN("system", "H=p^2/2 + k*q"), GEOMINT_USAGE, "k");
    expect_refusal(OPEN("/nowhere/such.system"), GEOMINT_FILE, "such.system");
    geomint *run = OPEN("kepler");
    double value;
    assert_int_equal(geomint_step(run, 1, 1), GEOMINT_USAGE);
    assert_int_equal(geomint_until(run, 0, NAN), GEOMINT_USAGE);
    assert_int_equal(geomint_observable(run, 0, "energy_eror", &value), GEOMINT_USAGE);
    assert_non_null(strstr(geomint_message(run), "energy_error"));
    assert_int_equal(geomint_observe(run, "nothing"), GEOMINT_USAGE);
    assert_int_equal(geomint_save(run, "picture.bmp", 100, 100, 1, NULL), GEOMINT_USAGE);
    assert_int_equal(geomint_save(run, "picture.png", 100, 100, 1, "a\tb"), GEOMINT_USAGE);
    assert_int_equal(geomint_save(run, "/dev/null/picture.png", 100, 100, 1, NULL), GEOMINT_FILE);
    assert_int_equal(geomint_step(run, 0, 1), GEOMINT_OK);
    assert_string_equal(geomint_message(run), "");
    geomint_close(run);
    geomint_close(NULL);
}

/* Every function takes the handle that there was no memory for, and no pointer where one is wanted. */
static void test_null(void **state)
{
    (void)state;
    size_t shape[3], made = 7;
    double numbers[64];
    unsigned char rgba[4];
    assert_int_equal(geomint_status(NULL), GEOMINT_MEMORY);
    assert_string_equal(geomint_message(NULL), "there is not enough memory");
    assert_null(geomint_text(NULL));
    assert_int_equal(geomint_lanes(NULL), 0);
    assert_int_equal(geomint_step(NULL, 0, 1), GEOMINT_MEMORY);
    assert_int_equal(geomint_until(NULL, 0, 1), GEOMINT_MEMORY);
    assert_int_equal(geomint_until(NULL, 0, NAN), GEOMINT_MEMORY);
    assert_true(isnan(geomint_time(NULL, 0)));
    assert_int_equal(geomint_steps(NULL, 0), 0);
    assert_int_equal(geomint_steps_left(NULL, 0), 0);
    assert_null(geomint_state(NULL, 0, shape, shape));
    assert_int_equal(geomint_observe(NULL, ""), GEOMINT_MEMORY);
    assert_int_equal(geomint_columns(NULL, 0), 0);
    assert_null(geomint_column_name(NULL, 0, 0));
    assert_null(geomint_column_unit(NULL, 0, 0));
    assert_int_equal(geomint_column_shape(NULL, 0, 0, shape), 0);
    assert_int_equal(geomint_column(NULL, 0, 0, numbers), GEOMINT_MEMORY);
    assert_int_equal(geomint_observable(NULL, 0, "t", numbers), GEOMINT_MEMORY);
    assert_int_equal(geomint_row_size(NULL, 0), 0);
    assert_int_equal(geomint_row(NULL, 0, NULL, numbers), GEOMINT_MEMORY);
    assert_int_equal(geomint_rows(NULL, 0, 1, 1, numbers, numbers, &made), GEOMINT_MEMORY);
    assert_int_equal(made, 0);
    assert_int_equal(geomint_draw(NULL, 100, 100, 1, rgba), GEOMINT_MEMORY);
    assert_int_equal(geomint_draw(NULL, 100, 100, 1, NULL), GEOMINT_MEMORY);
    assert_int_equal(geomint_save(NULL, "picture.png", 100, 100, 1, NULL), GEOMINT_MEMORY);
    assert_int_equal(geomint_save(NULL, NULL, 100, 100, 1, ""), GEOMINT_MEMORY);

    expect_refusal(geomint_open(2, NULL), GEOMINT_USAGE, "words is NULL");
    expect_refusal(OPEN("kepler", NULL), GEOMINT_USAGE, "one of the words is NULL");
    expect_refusal(geomint_open(-1, NULL), GEOMINT_USAGE, "which scene");
    expect_refusal(geomint_scheme(NULL), GEOMINT_USAGE, "the scheme is NULL");
    expect_refusal(geomint_certify(NULL, 0, NULL), GEOMINT_USAGE, "the scheme is NULL");
    expect_refusal(geomint_certify("rk2", 1, NULL), GEOMINT_USAGE, "words is NULL");
    geomint *run = OPEN("kepler", "until=1");
    assert_int_equal(geomint_observable(run, 0, NULL, numbers), GEOMINT_USAGE);
    assert_int_equal(geomint_observable(run, 0, "energy_error", NULL), GEOMINT_USAGE);
    assert_int_equal(geomint_column(run, 0, 0, NULL), GEOMINT_USAGE);
    assert_int_equal(geomint_column(run, 0, SIZE_MAX, numbers), GEOMINT_USAGE);
    assert_int_equal(geomint_column(run, SIZE_MAX, 0, numbers), GEOMINT_USAGE);
    assert_int_equal(geomint_row(run, 0, NULL, NULL), GEOMINT_USAGE);
    assert_int_equal(geomint_rows(run, 0, 1, 1, NULL, numbers, &made), GEOMINT_USAGE);
    assert_int_equal(geomint_rows(run, 0, 1, 1, numbers, NULL, NULL), GEOMINT_USAGE);
    assert_int_equal(geomint_draw(run, 100, 100, 1, NULL), GEOMINT_USAGE);
    assert_int_equal(geomint_save(run, NULL, 100, 100, 1, NULL), GEOMINT_USAGE);
    assert_int_equal(geomint_step(run, 0, -5), GEOMINT_OK);
    assert_int_equal(geomint_steps(run, 0), 0);
    assert_int_equal(geomint_rows(run, 0, LONG_MAX, 1, numbers, numbers, NULL), GEOMINT_OK);
    assert_int_equal(geomint_steps_left(run, 0), 0);
    geomint_close(run);
}

/* A process that was forked off goes on, and draws. OpenGL does not: its threads are not there, and it would wait for
   them; the rasteriser does. */
static void test_fork(void **state)
{
    (void)state;
    static const char *const painters[] = {"own", "auto", "osmesa"};
    for (size_t i = 0; i < sizeof painters / sizeof *painters; i++) {
        const bool opengl = strcmp(painters[i], "osmesa") == 0;
        setenv("GEOMINT_PAINTER", painters[i], 1);
        geomint *run = OPEN("kepler", "dt=0.01", "until=1");
        unsigned char *rgba = malloc(4 * 100 * 80);
        assert_int_equal(geomint_draw(run, 100, 80, 1, rgba), GEOMINT_OK);
        const pid_t child = fork();
        if (child == 0) {
            alarm(60);
            const bool goes_on = geomint_step(run, 0, 10) == GEOMINT_OK && geomint_steps(run, 0) == 10;
            const int drawn = geomint_draw(run, 100, 80, 1, rgba);
            const bool right = opengl ? drawn == GEOMINT_FILE && strstr(geomint_message(run), "was forked")
                                      : drawn == GEOMINT_OK;
            _exit(goes_on && right ? 0 : 1);
        }
        int status = -1;
        assert_int_equal(waitpid(child, &status, 0), child);
        assert_int_equal(status, 0);
        assert_int_equal(geomint_draw(run, 100, 80, 1, rgba), GEOMINT_OK);
        free(rgba);
        geomint_close(run);
    }
    unsetenv("GEOMINT_PAINTER");
}

/* Whether a file holds these bytes. */
static bool holds(const char *path, const char *bytes, size_t size)
{
    static char content[1 << 18];
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    const size_t length = fread(content, 1, sizeof content, file);
    fclose(file);
    return memmem(content, length, bytes, size) != NULL;
}

/* The variable says what paints, as the file tells, and is refused where it says nothing that there is. */
static void test_painter(void **state)
{
    (void)state;
    static const char osmesa[] = "geomint:painter\0osmesa, OpenGL", own[] = "geomint:painter\0own";
    char path[] = "/tmp/geomint-painter-XXXXXX.png", drawing[] = "/tmp/geomint-painter-XXXXXX.svg";
    close(mkstemps(path, 4));
    close(mkstemps(drawing, 4));
    geomint *run = OPEN("kepler", "dt=0.01", "until=1");
    unsigned char *pixels[] = {malloc(4 * 100 * 80), malloc(4 * 100 * 80)};
    for (int i = 0; i < 2; i++) {
        setenv("GEOMINT_PAINTER", i == 0 ? "" : "own", 1);
        assert_int_equal(geomint_save(run, path, 100, 80, 1, NULL), GEOMINT_OK);
        assert_int_equal(holds(path, osmesa, sizeof osmesa - 1), i == 0);
        assert_int_equal(holds(path, own, sizeof own - 1), i == 1);
        assert_int_equal(geomint_draw(run, 100, 80, 1, pixels[i]), GEOMINT_OK);
    }
    assert_memory_not_equal(pixels[0], pixels[1], 4 * 100 * 80); /* by some of their edges */
    setenv("GEOMINT_PAINTER", "vulkan", 1);
    assert_int_equal(geomint_draw(run, 100, 80, 1, pixels[0]), GEOMINT_USAGE);
    assert_non_null(strstr(geomint_message(run), "auto, osmesa, egl or own"));
    assert_int_equal(geomint_save(run, path, 100, 80, 1, NULL), GEOMINT_USAGE);
    assert_int_equal(geomint_save(run, drawing, 100, 80, 1, NULL), GEOMINT_OK); /* of no pixels */
    unsetenv("GEOMINT_PAINTER");
    unlink(path);
    unlink(drawing);
    free(pixels[0]);
    free(pixels[1]);
    geomint_close(run);
}

/* A system that carries the time has it once, as files do. */
static void test_time(void **state)
{
    (void)state;
    geomint *run = OPEN("system", "H=p^2/2 - q*cos(t)", "q=1", "p=0", "dt=0.1", "scheme=rk4");
    assert_int_equal(geomint_observe(run, ""), GEOMINT_OK);
    assert_int_equal(geomint_columns(run, 0), 2);
    assert_string_equal(geomint_column_name(run, 0, 0), "q");
    assert_string_equal(geomint_column_name(run, 0, 1), "p");
    size_t n = 0;
    assert_non_null(geomint_state(run, 0, &n, NULL));
    assert_int_equal(n, 3);
    geomint_close(run);
}

/* A harmonic oscillator by leapfrog, kick first, written down once more. */
static void test_numbers(void **state)
{
    (void)state;
    geomint *run = OPEN("system", "H=p^2/2 + q^2/2", "q=1", "p=0", "dt=0.125", "scheme=verlet", "until=10");
    assert_int_equal(geomint_status(run), GEOMINT_OK);
    size_t n = 0, m = 0;
    const double *y = geomint_state(run, 0, &n, &m);
    assert_int_equal(n, 2);
    assert_int_equal(m, 1);
    assert_true(y[0] == 1 && y[1] == 0);
    assert_int_equal(geomint_steps_left(run, 0), 80);
    double q = 1, p = 0;
    for (int step = 1; step <= 24; step++) {
        p -= 0.0625 * q;
        q += 0.125 * p;
        p -= 0.0625 * q;
        assert_int_equal(geomint_step(run, 0, 1), GEOMINT_OK);
        assert_ptr_equal(geomint_state(run, 0, NULL, NULL), y);
        assert_true(fabs(y[0] - q) < 1e-14 && fabs(y[1] - p) < 1e-14);
    }
    assert_true(geomint_time(run, 0) == 3);
    assert_int_equal(geomint_until(run, 0, 5), GEOMINT_OK);
    assert_int_equal(geomint_steps(run, 0), 40);
    /* rows: at 48, 64, 80 steps */
    assert_int_equal(geomint_observe(run, "energy_error"), GEOMINT_OK);
    assert_int_equal(geomint_columns(run, 0), 3);
    assert_string_equal(geomint_column_name(run, 0, 0), "q");
    assert_string_equal(geomint_column_name(run, 0, 1), "p");
    assert_string_equal(geomint_column_name(run, 0, 2), "energy_error");
    assert_null(geomint_column_name(run, 0, 3));
    assert_int_equal(geomint_row_size(run, 0), 3);
    double t[8], rows[8][3];
    size_t made = 0;
    assert_int_equal(geomint_rows(run, 0, 16, 8, t, &rows[0][0], &made), GEOMINT_OK);
    assert_int_equal(made, 3);
    assert_true(t[0] == 6 && t[1] == 8 && t[2] == 10);
    assert_true(rows[2][0] == y[0] && rows[2][1] == y[1]);
    const double energy = (y[0] * y[0] + y[1] * y[1]) / 2;
    assert_true(fabs(rows[2][2] - fabs(energy - 0.5) / 0.5) < 1e-14);
    assert_int_equal(geomint_steps_left(run, 0), 0);
    assert_int_equal(geomint_rows(run, 0, 0, 8, t, &rows[0][0], &made), GEOMINT_USAGE);
    geomint_close(run);
}

static void test_failure(void **state)
{
    (void)state;
    geomint *run =
        OPEN("system", "H=p^2/2 - q^4/4", "q=1", "p=1", "dt=0.5", "scheme=explicit-euler", "until=1000");
    assert_int_equal(geomint_until(run, 0, 1000), GEOMINT_NUMERICAL);
    assert_non_null(strstr(geomint_message(run), "led beyond"));
    const long steps = geomint_steps(run, 0);
    assert_true(steps > 0 && steps < 2000);
    assert_int_equal(geomint_step(run, 0, 1), GEOMINT_NUMERICAL);
    assert_int_equal(geomint_steps(run, 0), steps);
    assert_non_null(strstr(geomint_text(run), "\"blow-up\""));
    geomint_close(run);
}

/* Of systems that the build compiled the steps are made by its loops, and of others by the interpreter. */
static void test_engines(void **state)
{
    (void)state;
    geomint *compiled = OPEN("kepler", "scheme=rk4"),
            *typed = OPEN("system", "H=p^2/2 - cos(3*q)", "q=1", "p=0");
    assert_non_null(strstr(geomint_text(compiled), "\"engine\":\"native\""));
    assert_non_null(strstr(geomint_text(typed), "\"engine\":\"interpreted\""));
    geomint_close(compiled);
    geomint_close(typed);
}

/* A scheme that chooses its steps. */
static void test_adaptive(void **state)
{
    (void)state;
    geomint *run = OPEN("oscillator", "scheme=variational-rectangle-restart", "until=3");
    double value;
    assert_int_equal(geomint_steps_left(run, 0), -1);
    assert_int_equal(geomint_until(run, 0, 2), GEOMINT_OK);
    assert_true(geomint_time(run, 0) >= 2 && geomint_time(run, 0) < 2.2);
    const long steps = geomint_steps(run, 0);
    assert_int_equal(geomint_step(run, 0, 3), GEOMINT_OK);
    assert_int_equal(geomint_steps(run, 0), steps + 3);
    assert_int_equal(geomint_until(run, 0, 3), GEOMINT_OK);
    assert_int_equal(geomint_steps_left(run, 0), 0);
    assert_int_equal(geomint_observable(run, 0, "energy_error", &value), GEOMINT_OK);
    assert_true(value < 1e-9);
    geomint_close(run);
}

/* Four problems, one a thread, and all at once: the bits are those of runs one after the other. */
static const char *const jobs[][6] = {
    {"kepler", "scheme=rk4", "eccentricity=0.6", "dt=0.01", "steps=20000"},
    {"system", "H=p^2/2 + q^4/4 - q^2/2", "q=1.5", "p=0", "scheme=gauss4", "steps=4000"},
    {"kepler", "scheme=gsl-rk4", "eccentricity=0.6", "dt=0.01", "steps=4000"},
    {"sine-gordon", "steps=400"},
};
enum { JOBS = sizeof jobs / sizeof *jobs, NUMBERS = 4096 };

struct job {
    int number;
    size_t count;
    double numbers[NUMBERS];
};

static void *work(void *data)
{
    struct job *job = data;
    int count = 0;
    while (count < 6 && jobs[job->number][count]) {
        count++;
    }
    geomint *run = geomint_open(count, jobs[job->number]);
    size_t n = 0, m = 0;
    const double *y = geomint_state(run, 0, &n, &m);
    while (geomint_steps_left(run, 0) > 0) {
        geomint_step(run, 0, 100);
    }
    job->count = n * m < NUMBERS ? n * m : NUMBERS;
    memcpy(job->numbers, y, job->count * sizeof *y);
    geomint_close(run);
    return NULL;
}

static void test_threads(void **state)
{
    (void)state;
    struct job *all = calloc(3 * JOBS, sizeof *all);
    pthread_t threads[2 * JOBS];
    for (int i = 0; i < 3 * JOBS; i++) {
        all[i].number = i % JOBS;
    }
    for (int i = 0; i < 2 * JOBS; i++) {
        assert_int_equal(pthread_create(&threads[i], NULL, work, &all[i]), 0);
    }
    for (int i = 0; i < 2 * JOBS; i++) {
        pthread_join(threads[i], NULL);
    }
    for (int i = 0; i < JOBS; i++) {
        work(&all[2 * JOBS + i]);
        assert_true(all[2 * JOBS + i].count > 0);
        assert_memory_equal(all[i].numbers, all[2 * JOBS + i].numbers, sizeof all->numbers);
        assert_memory_equal(all[JOBS + i].numbers, all[2 * JOBS + i].numbers, sizeof all->numbers);
    }
    free(all);
}

static void note(const char *reason, const char *file, int line, int error)
{
    (void)reason, (void)file, (void)line, (void)error;
}

static const int signals[] = {SIGINT, SIGTERM, SIGSEGV, SIGABRT, SIGFPE, SIGPIPE};
enum { SIGNALS = sizeof signals / sizeof *signals };

/* What a picture, a certificate and a run of GSL's stepper leave behind. */
static void test_host(void **state)
{
    (void)state;
    static const char *const commas[] = {"de_DE.UTF-8", "fr_FR.UTF-8", "de_DE", "fr_FR"};
    for (size_t i = 0; i < 4 && !setlocale(LC_ALL, commas[i]); i++) {
    }
    char *before = strdup(setlocale(LC_ALL, NULL));
    const locale_t own = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    uselocale(own);
    gsl_error_handler_t *standard = gsl_set_error_handler(note);
    struct sigaction old[SIGNALS], now;
    for (int i = 0; i < SIGNALS; i++) {
        sigaction(signals[i], NULL, &old[i]);
    }
    geomint *run = OPEN("kepler", "scheme=gsl-rk4,verlet", "dt=0.05", "until=5");
    assert_int_equal(geomint_lanes(run), 2);
    assert_int_equal(geomint_until(run, 0, 2.5), GEOMINT_OK);
    enum { WIDTH = 320, HEIGHT = 180 };
    unsigned char *rgba = malloc(4 * WIDTH * HEIGHT);
    assert_int_equal(geomint_draw(run, WIDTH, HEIGHT, 1, rgba), GEOMINT_OK);
    int colours = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        assert_int_equal(rgba[4 * i + 3], 255);
        colours += memcmp(&rgba[4 * i], rgba, 3) != 0;
    }
    assert_true(colours > 100);
    assert_int_equal(geomint_draw(run, 0, HEIGHT, 1, rgba), GEOMINT_USAGE);
    assert_int_equal(geomint_draw(run, -1, -1, 1, rgba), GEOMINT_USAGE);
    assert_int_equal(geomint_draw(run, WIDTH, INT_MAX, 1, rgba), GEOMINT_USAGE);
    assert_int_equal(geomint_draw(run, WIDTH, HEIGHT, NAN, rgba), GEOMINT_USAGE);
    assert_int_equal(geomint_save(run, "picture.svg", 0, HEIGHT, 1, NULL), GEOMINT_USAGE);
    assert_int_equal(geomint_save(run, "picture.pdf", WIDTH, HEIGHT, -1, NULL), GEOMINT_USAGE);
    geomint *certificate = geomint_certify("rk2", 0, NULL);
    assert_int_equal(geomint_status(certificate), GEOMINT_OK);
    assert_non_null(strstr(geomint_text(certificate), "\"measured\""));
    geomint_close(certificate);
    geomint *scheme = geomint_scheme("verlet");
    assert_non_null(strstr(geomint_text(scheme), "\"order\":2"));
    geomint_close(scheme);
    expect_refusal(geomint_scheme("verlett"), GEOMINT_USAGE, "did you mean verlet");
    for (int i = 0; i < SIGNALS; i++) {
        sigaction(signals[i], NULL, &now);
        assert_ptr_equal(now.sa_handler, old[i].sa_handler);
    }
    assert_ptr_equal(gsl_set_error_handler(standard), note);
    assert_ptr_equal(uselocale((locale_t)0), own);
    uselocale(LC_GLOBAL_LOCALE);
    freelocale(own);
    assert_string_equal(setlocale(LC_ALL, NULL), before);
    /* "0.05" was read with a point, also where the host has a comma */
    assert_true(fabs(geomint_time(run, 0) - 2.5) < 1e-12);
    free(before);
    free(rgba);
    geomint_close(run);
    setlocale(LC_ALL, "C");
}

/* A false claim is told. */
static void test_claims(void **state)
{
    (void)state;
    geomint *certificate = geomint_certify("verlet", 2, (const char *[]){"system", "H=p^2/2 + q^4/4"});
    expect_refusal(certificate, GEOMINT_USAGE, "q");
    certificate = geomint_certify("verlet", 4, (const char *[]){"system", "H=p^2/2 + q^4/4", "q=1", "p=0"});
    assert_int_equal(geomint_status(certificate), GEOMINT_OK);
    assert_non_null(strstr(geomint_text(certificate), "\"symplectic\""));
    geomint_close(certificate);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_refusals), cmocka_unit_test(test_null),    cmocka_unit_test(test_time),
        cmocka_unit_test(test_numbers),  cmocka_unit_test(test_failure), cmocka_unit_test(test_adaptive),
        cmocka_unit_test(test_threads),  cmocka_unit_test(test_host),    cmocka_unit_test(test_claims),
        cmocka_unit_test(test_fork),     cmocka_unit_test(test_painter), cmocka_unit_test(test_engines),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
