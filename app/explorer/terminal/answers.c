/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Separates a terminal's answers and mouse reports from the keys, byte by byte, even if they are late or
   incomplete. */
#include "app/explorer/terminal/device.h"

#include <ctype.h>
#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <termios.h>
#include <unistd.h>

#include "core/basics.h"
#include "render/clock.h"

/* ---- one answer ---- */

enum verdict { KEYS, PERHAPS, ANSWER };

static bool is_parameter(char c)
{
    return (c >= '0' && c <= '9') || c == ';';
}

/* The starts of the answers that are strings; each differs from any key. */
static const char images[] = "\033_G", ground[] = "\033]11;", setting[] = "\033P1$r",
                  no_setting[] = "\033P0$r";
static const char *const strings[] = {images, ground, setting, no_setting};

/* Judges a string, which ends with ST, or with the bell as in old xterm. */
static enum verdict judge_string(const char *held, size_t count, const char *begin)
{
    const size_t size = strlen(begin);
    if (count <= size) {
        return memcmp(held, begin, count) == 0 ? PERHAPS : KEYS;
    }
    if (memcmp(held, begin, size) != 0) {
        return KEYS;
    }
    const bool ends = held[count - 1] == '\a' || (held[count - 2] == '\033' && held[count - 1] == '\\');
    return ends ? ANSWER : PERHAPS;
}

/* Judges the held bytes: an answer, the start of one, or keys. No key of ncurses begins like one of the
   strings or with CSI ?, or ends its numbers with n, t. */
static enum verdict judge(const char *held, size_t count)
{
    if (count < 2) {
        return PERHAPS;
    }
    for (size_t i = 0; i < GM_COUNT(strings); i++) {
        const enum verdict verdict = judge_string(held, count, strings[i]);
        if (verdict != KEYS) {
            return verdict;
        }
    }
    if (held[1] != '[') {
        return KEYS;
    }
    size_t from = count > 2 && held[2] == '?' ? 3 : 2, at = from;
    while (at < count && is_parameter(held[at])) {
        at++;
    }
    if (at == count) {
        return PERHAPS;
    }
    if (from == 3) { /* attributes, limits of graphics, modes */
        if (held[at] == '$' && at + 1 == count) {
            return PERHAPS;
        }
        return ANSWER;
    }
    return at > from && (held[at] == 't' || held[at] == 'n') ? ANSWER : KEYS;
}

enum { NUMBERS = 16 };

static int read_numbers(const char *text, int numbers[NUMBERS])
{
    int count = 0;
    while (is_parameter(*text) && count < NUMBERS) {
        char *end;
        numbers[count++] = (int)strtol(text, &end, 10);
        text = *end == ';' ? end + 1 : end;
    }
    return count;
}

static void take_private(struct gm_answers *answers, const int *numbers, int count, char end)
{
    if (end == 'c') {
        answers->attributes = true;
        for (int i = 1; i < count; i++) { /* the first number is the class of the terminal */
            answers->sixel = answers->sixel || numbers[i] == 4;
        }
    } else if (end == 'S' && count >= 3 && numbers[1] == 0) {
        if (numbers[0] == 1) {
            answers->registers = numbers[2];
        } else if (numbers[0] == 2 && count >= 4) {
            answers->most_width = numbers[2];
            answers->most_height = numbers[3];
        }
    } else if (end == 'y' && count >= 2 && numbers[0] == 2026) {
        answers->synchronised = numbers[1] == 1 || numbers[1] == 2;
    }
}

/* Reads the luminance (Rec. 709) of rgb:RRRR/GGGG/BBBB, with one to four digits each, or rgba: with a
   fourth. */
static void take_ground(struct gm_answers *answers, const char *text)
{
    static const double weights[] = {0.2126, 0.7152, 0.0722};
    double luminance = 0;
    const char *digits = strchr(text, ':');
    for (size_t i = 0; i < 3; i++) {
        char *end;
        if (!digits || !isxdigit((unsigned char)digits[1])) {
            return;
        }
        const unsigned long value = strtoul(digits + 1, &end, 16);
        const long count = end - (digits + 1);
        if (count > 4 || (i < 2 && *end != '/')) {
            return;
        }
        luminance += weights[i] * (double)value / (double)((1UL << 4 * count) - 1);
        digits = end;
    }
    answers->ground_told = true;
    answers->ground = luminance;
}

static void take(struct gm_answers *answers)
{
    char *held = answers->held;
    int numbers[NUMBERS] = {0};
    char end = held[answers->count - 1];
    if (held[1] == '_') {
        answers->kitty = answers->kitty || strstr(held, ";OK\033") != NULL;
        return;
    }
    if (held[1] == ']') {
        take_ground(answers, held + sizeof ground - 1);
        return;
    }
    if (held[1] != '[') {
        /* the answer has the colour that was set, or the nearest one of a palette */
        const bool direct = strstr(held, "48:2:") || strstr(held, "48;2;");
        answers->true_colour =
            answers->true_colour || (direct && (strstr(held, "1:2:3") || strstr(held, "1;2;3")));
        return;
    }
    if (held[2] == '?') {
        take_private(answers, numbers, read_numbers(held + 3, numbers), end);
        return;
    }
    int count = read_numbers(held + 2, numbers);
    if (end == 'n') {
        answers->ready++;
    } else if (end == 't' && count >= 3 && numbers[0] == 6) {
        answers->cell_height = numbers[1];
        answers->cell_width = numbers[2];
    } else if (end == 't' && count >= 3 && numbers[0] == 4) {
        answers->text_height = numbers[1];
        answers->text_width = numbers[2];
    }
}

/* ---- the stream ---- */

size_t gm_answers_release(struct gm_answers *answers, char *keys)
{
    size_t count = answers->count;
    memcpy(keys, answers->held, count);
    answers->count = 0;
    return count;
}

size_t gm_answers_sort(struct gm_answers *answers, const char *bytes, size_t count, char *keys)
{
    size_t written = 0;
    for (size_t i = 0; i < count; i++) {
        if (answers->count == 0 && bytes[i] != '\033') {
            keys[written++] = bytes[i];
            continue;
        }
        bool ends = bytes[i] == '\033' && answers->count > 2 && answers->held[1] != '[';
        if (bytes[i] == '\033' && answers->count > 0 && !ends) { /* another answer begins */
            written += gm_answers_release(answers, keys + written);
        }
        answers->held[answers->count++] = bytes[i];
        answers->held[answers->count] = '\0';
        enum verdict verdict = judge(answers->held, answers->count);
        if (verdict == ANSWER) {
            take(answers);
            answers->count = 0;
        } else if (verdict == KEYS || answers->count + 1 == GM_ANSWER_LONGEST) {
            written += gm_answers_release(answers, keys + written);
        }
    }
    return written;
}

/* ---- asking ---- */

static void send_all(const char *text)
{
    for (size_t left = strlen(text); left > 0;) {
        ssize_t done = write(STDOUT_FILENO, text, left);
        if (done > 0) {
            text += done;
            left -= (size_t)done;
        } else if (errno != EINTR) {
            return;
        }
    }
}

/* Sends questions and waits. The last one must be for the attributes, which every terminal answers. */
static void ask(struct gm_answers *answers, const char *questions, int patience, char *typed,
                size_t *typed_size)
{
    const int64_t until = gm_clock_milliseconds() + patience;
    answers->attributes = false;
    send_all(questions);
    while (!answers->attributes) {
        char bytes[512], keys[sizeof bytes + GM_ANSWER_LONGEST];
        const int left = (int)(until - gm_clock_milliseconds());
        struct pollfd watched = {.fd = STDIN_FILENO, .events = POLLIN};
        if (left <= 0 || *typed_size + sizeof keys > GM_TYPED_AHEAD) {
            return;
        }
        int ready = poll(&watched, 1, left);
        if (ready < 0 && errno == EINTR) {
            continue;
        }
        ssize_t count = ready > 0 ? read(STDIN_FILENO, bytes, sizeof bytes) : 0;
        if (count <= 0) {
            return;
        }
        size_t size = gm_answers_sort(answers, bytes, (size_t)count, keys);
        memcpy(typed + *typed_size, keys, size);
        *typed_size += size;
    }
}

/* sets a background in true colour, asks which one is set (DECRQSS), and resets all attributes */
#define ASK_TRUE_COLOUR "\033[48;2;1;2;3m\033P$qm\033\\\033[m"
#define ASK_GROUND "\033]11;?\033\\"
#define ASK_SYNCHRONISED "\033[?2026$p\033[c"
/* only asks about an image of one pixel (a=q) */
#define ASK_IMAGES "\033_Gi=31,s=1,v=1,a=q,t=d,f=24;AAAA\033\\"

int gm_answers_ask(struct gm_answers *answers, enum gm_ask which, int patience, char *typed,
                   size_t *typed_size)
{
    static const char *const questions[] = {
        [GM_ASK_PLAIN] = ASK_SYNCHRONISED,
        [GM_ASK_GROUND] = ASK_GROUND ASK_SYNCHRONISED,
        [GM_ASK_ALL] = ASK_IMAGES ASK_GROUND ASK_TRUE_COLOUR ASK_SYNCHRONISED,
    };
    struct termios before, raw;
    const int64_t begun = gm_clock_milliseconds();
    *answers = (struct gm_answers){0};
    *typed_size = 0;
    /* a background process may not change the terminal's settings */
    if (tcgetpgrp(STDIN_FILENO) != getpgrp() || tcgetattr(STDIN_FILENO, &before) != 0) {
        return 0;
    }
    /* signals wait until the settings are restored */
    sigset_t all, unblocked;
    sigfillset(&all);
    sigprocmask(SIG_BLOCK, &all, &unblocked);
    raw = before;
    raw.c_lflag &= ~(tcflag_t)(ICANON | ECHO | ISIG); /* Ctrl-C is read as a byte */
    raw.c_cc[VMIN] = 1;
    raw.c_cc[VTIME] = 0;
    tcsetattr(STDIN_FILENO, TCSANOW, &raw); /* bytes typed earlier remain */
    ask(answers, questions[which], patience, typed, typed_size);
    if (answers->attributes && (answers->sixel || answers->kitty)) {
        ask(answers, GM_ASK_LIMITS, patience, typed, typed_size);
        answers->attributes = true;
    }
    tcsetattr(STDIN_FILENO, TCSANOW, &before);
    if (memchr(typed, before.c_cc[VINTR], *typed_size)) {
        raise(SIGINT);
    }
    sigprocmask(SIG_SETMASK, &unblocked, NULL);
    return (int)(gm_clock_milliseconds() - begun);
}

/* ---- the mouse ---- */

enum { BUTTON = 3, SHIFTS = 4 + 8 + 16, MOVES = 32, WHEEL = 64 };

static bool understand(const char *text, char end, struct gm_mouse_event *event)
{
    int code, column, row;
    if (sscanf(text, "%d;%d;%d", &code, &column, &row) != 3 || column < 1 || row < 1) {
        return false;
    }
    code &= ~SHIFTS;
    event->column = column - 1;
    event->row = row - 1;
    if (code == WHEEL || code == WHEEL + 1) {
        event->kind = code == WHEEL ? GM_MOUSE_UP : GM_MOUSE_DOWN;
        return end == 'M';
    }
    if ((code & ~MOVES & ~BUTTON) != 0 || (code & BUTTON) != 0) {
        return false; /* only the left button counts */
    }
    event->kind = end == 'm' ? GM_MOUSE_RELEASE : code & MOVES ? GM_MOUSE_DRAG : GM_MOUSE_PRESS;
    return true;
}

enum gm_mouse_result gm_mouse_feed(struct gm_mouse *mouse, int key, struct gm_mouse_event *event)
{
    if (key == GM_KEY_MOUSE) {
        mouse->reading = true;
        mouse->length = 0;
        return GM_MOUSE_PART;
    }
    if (!mouse->reading) {
        return GM_MOUSE_NOT;
    }
    if (key == 'M' || key == 'm') {
        mouse->reading = false;
        mouse->text[mouse->length] = '\0';
        return understand(mouse->text, (char)key, event) ? GM_MOUSE_EVENT : GM_MOUSE_PART;
    }
    if (mouse->length + 1 == sizeof mouse->text || !((key >= '0' && key <= '9') || key == ';')) {
        mouse->reading = false;
        return GM_MOUSE_NOT;
    }
    mouse->text[mouse->length++] = (char)key;
    return GM_MOUSE_PART;
}
