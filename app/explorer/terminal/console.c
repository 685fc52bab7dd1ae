/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The terminal as a device: modes, keys, signals, and every way out of it. */
#include "app/explorer/terminal/device.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

#include "app/base/interrupt.h"
#include "app/explorer/terminal/curses.h"
#include "app/words/request.h"
#include "core/basics.h"
#include "render/clock.h"

static SCREEN *screen;
static WINDOW *keys; /* a pad: reading its keys does not make ncurses draw */
static int wake_fd = -1;
/* ncurses reads the keys from a pipe, without the answers */
static FILE *input;
static int feed_fd = -1;
static struct gm_answers *answers;
static int64_t heard;         /* time (ms) of the last byte read */
static struct termios before; /* the shell's settings */
static char parting[256];     /* the bytes that restore the terminal, prepared for signal handlers */
static size_t parting_size;
static volatile sig_atomic_t active, leaving, resized, stopping, lost, given_back;
static pthread_t owner; /* the thread that owns the terminal */
static bool reports_mouse;

/* ---- signals ---- */

static void announce(void)
{
    int error = errno;
    const uint64_t one = 1;
    if (write(wake_fd, &one, sizeof one) < 0) {
        /* the count is full: the loop is awake */
    }
    errno = error;
}

static struct sigaction handled_before[NSIG];
static bool handled;

enum { ROOM = 1000, HOLD = 3000 }; /* milliseconds to wait for a busy terminal, or its thread */
enum { PATIENCE = 2 };             /* seconds for the loop to notice a signal to leave */

static void give_back_at_once(void)
{
    if (active) {
        /* a terminal that accepts nothing would block */
        if (poll(&(struct pollfd){.fd = STDOUT_FILENO, .events = POLLOUT}, 1, ROOM) > 0 &&
            write(STDOUT_FILENO, parting, parting_size) < 0) {
            /* nothing can be done about it */
        }
        tcsetattr(STDIN_FILENO, TCSANOW, &before);
        active = 0;
    }
}

/* Restores the terminal in a crash. Its owner does that and writes nothing afterwards; the thread with the
   fault then dies. */
static void on_crash(int number)
{
    if (pthread_equal(pthread_self(), owner)) {
        give_back_at_once();
        given_back = 1;
        while (lost) {
            pause();
        }
    } else {
        lost = 1;
        pthread_kill(owner, number);
        /* also when inactive: the owner may be about to take the terminal over */
        for (int waited = 0; !given_back && waited < HOLD; waited++) {
            nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
        }
        give_back_at_once(); /* the owner may be unable to */
    }
    sigaction(number, &handled_before[number], NULL);
    raise(number);
}

/* Asks the explorer to leave. A closing terminal sends several signals, itself and through the shell, so
   the second does not interrupt unfinished files. The third ends the process at once; so does the alarm,
   if the loop does not respond for seconds, as when it opens a fine mesh. */
static void on_leave(int number)
{
    const bool asks = number == SIGINT || number == SIGTERM || number == SIGQUIT;
    const bool late = number == SIGALRM && gm_interrupted > 0;
    if (late || (asks && gm_interrupted > 1)) {
        number = late ? leaving : number;
        give_back_at_once();
        signal(number, SIG_DFL);
        raise(number);
        return;
    }
    if (asks && gm_interrupted == 0) {
        alarm(PATIENCE);
    }
    gm_interrupted = gm_interrupted + asks;
    leaving = leaving ? leaving : number;
    announce();
}

static void on_resize(int number)
{
    (void)number;
    resized = 1;
    announce();
}

static void on_stop(int number)
{
    (void)number;
    stopping = 1;
    announce();
}

static void (*handler_of(int number))(int)
{
    static const struct {
        int number;
        void (*handler)(int);
    } rows[] = {
        {SIGINT, on_leave},    {SIGTERM, on_leave}, {SIGQUIT, on_leave},   {SIGHUP, on_leave},
        {SIGUSR1, on_leave},   {SIGUSR2, on_leave}, {SIGALRM, on_leave},   {SIGVTALRM, on_leave},
        {SIGPROF, on_leave},   {SIGXCPU, on_leave}, {SIGIO, on_leave},     {SIGPWR, on_leave},
        {SIGSTKFLT, on_leave}, {SIGSEGV, on_crash}, {SIGABRT, on_crash},   {SIGBUS, on_crash},
        {SIGFPE, on_crash},    {SIGILL, on_crash},  {SIGTRAP, on_crash},   {SIGSYS, on_crash},
        {SIGTSTP, on_stop},    {SIGPIPE, SIG_IGN},  {SIGWINCH, on_resize}, /* before ncurses starts, so that it does not install a handler that draws */
    };
    for (size_t i = 0; i < GM_COUNT(rows); i++) {
        if (rows[i].number == number) {
            return rows[i].handler;
        }
    }
    return number >= SIGRTMIN && number <= SIGRTMAX ? on_leave : NULL;
}

static void handle(int number, void (*handler)(int), struct sigaction *old)
{
    /* restarted, as stdio would lose bytes; poll returns anyway */
    struct sigaction action = {.sa_handler = handler, .sa_flags = SA_RESTART};
    sigemptyset(&action.sa_mask);
    sigaction(number, &action, old);
}

static void handle_all(void)
{
    handled = true;
    for (int number = 1; number < NSIG; number++) {
        if (handler_of(number)) {
            handle(number, handler_of(number), &handled_before[number]);
        }
    }
}

static void unhandle_all(void)
{
    for (int number = 1; handled && number < NSIG; number++) {
        if (handler_of(number)) {
            sigaction(number, &handled_before[number], NULL);
        }
    }
}

/* ---- the terminal ---- */

static void prepare_parting(bool modern)
{
    /* the first one ends a half-written sequence or image, which would swallow the rest */
    const char *const texts[] = {modern ? "\030\033\\\033[?2026l" : NULL,
                                 reports_mouse ? GM_MOUSE_OFF : NULL,
                                 gm_capability("sgr0"),
                                 gm_capability("rmkx"),
                                 gm_capability("cnorm"),
                                 gm_capability("clear"),
                                 gm_capability("rmcup")};
    parting_size = 0;
    for (size_t i = 0; i < GM_COUNT(texts); i++) {
        parting_size += gm_capability_copy(texts[i], parting + parting_size, sizeof parting - parting_size);
    }
}

static void say_mouse(const char *mode)
{
    if (reports_mouse) {
        fputs(mode, stdout);
        fflush(stdout);
    }
}

static void take_over(void)
{
    active = 1;
    /* Draws a blank screen, once: here ncurses switches to the alternate screen. */
    gm_curses()->clearok(*gm_curses()->stdscr, TRUE);
    gm_curses()->wrefresh(*gm_curses()->stdscr);
    say_mouse(GM_MOUSE_ON);
}

static void give_back(void)
{
    say_mouse(GM_MOUSE_OFF);
    /* ncurses did not draw, so it does not know the current attributes */
    if (gm_capability("sgr0")) {
        gm_curses()->putp(gm_capability("sgr0"));
    }
    /* clear even with an alternate screen: GNU screen claims one and mostly has none */
    gm_curses()->clearok(*gm_curses()->stdscr, TRUE);
    gm_curses()->wrefresh(*gm_curses()->stdscr);
    gm_curses()->endwin();
    active = 0;
}

static bool open_input(const struct gm_terminal *terminal)
{
    int ends[2];
    if (pipe2(ends, O_CLOEXEC | O_NONBLOCK) != 0) {
        return false;
    }
    feed_fd = ends[1];
    input = fdopen(ends[0], "r");
    if (!input) {
        close(ends[0]);
    }
    return input && write(feed_fd, terminal->typed, terminal->typed_size) == (ssize_t)terminal->typed_size;
}

static void close_input(void)
{
    if (input) {
        fclose(input);
    }
    if (feed_fd >= 0) {
        close(feed_fd);
    }
    input = NULL;
    feed_fd = -1;
}

/* Defines the ordinary sequences, which are the ones typed before keypad() changes them. */
static void define_ordinary_arrows(void)
{
    gm_curses()->define_key("\033[A", KEY_UP);
    gm_curses()->define_key("\033[B", KEY_DOWN);
    gm_curses()->define_key("\033[C", KEY_RIGHT);
    gm_curses()->define_key("\033[D", KEY_LEFT);
    gm_curses()->define_key("\033[1;2A", KEY_SR); /* with shift, which few terminfo entries name */
    gm_curses()->define_key("\033[1;2B", KEY_SF);
    gm_curses()->define_key("\033[1;2C", KEY_SRIGHT);
    gm_curses()->define_key("\033[1;2D", KEY_SLEFT);
}

static bool open_screen(int wake, struct gm_terminal *terminal, char *message)
{
    wake_fd = wake;
    owner = pthread_self();
    answers = &terminal->answers;
    leaving = resized = stopping = 0;
    if (tcgetattr(STDIN_FILENO, &before) != 0) {
        return gm_refuse(message, "The terminal does not report its settings: %s.", strerror(errno));
    }
    if (!open_input(terminal)) {
        close_input();
        return gm_refuse(message, "There is no room for the keys: %s.", strerror(errno));
    }
    handle_all();
    screen = gm_curses()->newterm(NULL, stdout, input);
    if (!screen) {
        unhandle_all();
        close_input();
        return gm_refuse(message, "ncurses cannot use the terminal \"%.40s\".", getenv("TERM"));
    }
    active = 1;
    gm_curses()->set_escdelay(25);
    gm_curses()->cbreak();
    gm_curses()->noqiflush(); /* a signal's key would discard half of a sequence */
    gm_curses()->noecho();
    gm_curses()->nonl();
    gm_curses()->curs_set(0);
    keys = gm_curses()->newpad(1, 1);
    if (!keys) {
        gm_console_close();
        gm_console_release();
        return gm_refuse(message, "There is not enough memory.");
    }
    gm_curses()->keypad(keys, TRUE);
    define_ordinary_arrows();
    gm_curses()->nodelay(keys, TRUE);
    reports_mouse = gm_curses()->tigetnum("colors") >= 8; /* old terminals would show the letters */
    gm_curses()->define_key(GM_MOUSE_FRONT, GM_KEY_MOUSE);
    prepare_parting(gm_curses()->tigetnum("colors") >= 256);
    take_over();
    static bool registered;
    if (!registered) {
        registered = atexit(gm_console_close) == 0;
    }
    return true;
}

bool gm_console_open(int wake, struct gm_terminal *terminal, char *message)
{
    /* signals wait until the terminal can be restored */
    sigset_t all, unblocked;
    sigfillset(&all);
    sigprocmask(SIG_BLOCK, &all, &unblocked);
    const bool opened = open_screen(wake, terminal, message);
    sigprocmask(SIG_SETMASK, &unblocked, NULL);
    return opened;
}

void gm_console_close(void)
{
    if (!screen) {
        return;
    }
    if (active) { /* not while stopped: another process has the terminal then */
        give_back();
    }
    if (keys) {
        gm_curses()->delwin(keys);
    }
    gm_curses()->delscreen(screen);
    close_input();
    keys = NULL;
    screen = NULL;
}

void gm_console_release(void)
{
    unhandle_all();
    handled = false;
}

/* milliseconds between bytes of one sequence, which only the line can separate */
enum { BELONGS_TOGETHER = 50 };

int gm_console_patience(void)
{
    if (answers->count == 0) {
        return -1;
    }
    const int64_t passed = gm_clock_milliseconds() - heard;
    return passed < BELONGS_TOGETHER ? (int)(BELONGS_TOGETHER - passed) : 0;
}

/* Passes keys on to ncurses. */
static void feed(void)
{
    char bytes[1024], typed[sizeof bytes + GM_ANSWER_LONGEST];
    size_t size = 0;
    if (poll(&(struct pollfd){.fd = feed_fd, .events = POLLOUT}, 1, 0) <= 0) {
        return; /* pasted text waits for room: none is lost */
    }
    if (poll(&(struct pollfd){.fd = STDIN_FILENO, .events = POLLIN}, 1, 0) > 0) {
        ssize_t count = read(STDIN_FILENO, bytes, sizeof bytes);
        if (count > 0) {
            heard = gm_clock_milliseconds();
            size = gm_answers_sort(answers, bytes, (size_t)count, typed);
        }
    } else if (gm_console_patience() == 0) {
        size = gm_answers_release(answers, typed);
    }
    if (size > 0 && write(feed_fd, typed, size) < 0) {
        gm_curses()->beep(); /* these keys are lost */
    }
}

int gm_console_key(void)
{
    if (!active) { /* it leaves after a stop: ncurses would switch the keypad on in a terminal that is given back */
        return -1;
    }
    feed();
    int key = gm_curses()->wgetch(keys);
    return key == ERR ? -1 : key;
}

int gm_console_leaving(void)
{
    return leaving;
}

bool gm_console_resized(void)
{
    bool was = resized;
    resized = 0;
    if (was) {
        int columns, rows;
        gm_terminal_size(&columns, &rows);
        gm_curses()->resizeterm(rows, columns);
    }
    return was;
}

bool gm_console_stopping(void)
{
    bool was = stopping;
    stopping = 0;
    return was;
}

void gm_console_stop(void)
{
    struct sigaction ours;
    give_back();
    /* Not SIGSTOP: the system ignores SIGTSTP if no shell could resume the process. */
    handle(SIGTSTP, SIG_DFL, &ours);
    raise(SIGTSTP);
    sigaction(SIGTSTP, &ours, NULL);
    if (leaving) {
        return;
    }
    gm_curses()->reset_prog_mode();
    gm_curses()->curs_set(0);
    take_over();
    resized = 1;
}
