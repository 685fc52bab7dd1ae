/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Decides how to show pictures, from options, environment, answers and terminfo, and records the reasons. */
#include "app/explorer/terminal/device.h"

#include <langinfo.h>
#include <locale.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "app/base/arguments.h"
#include "app/explorer/terminal/curses.h"
#include "app/output/say.h"
#include "core/basics.h"
#include "core/memory.h"
#include "render/message.h"
#include "render/pixels/canvas.h"

GM_LIBRARY(gm_curses, "libncursesw.so.6", GM_CURSES_NAMES)

static const char *const colours_names[] = {"none", "16", "256", "truecolor", NULL};
static const char *const graphics_names[] = {"kitty", "sixel", "braille", "quadrants", "half", "ascii", NULL};
static const char *const theme_names[] = {"light", "dark", "mono", NULL};
enum { LIGHT, DARK, MONO };

/* the ways to show pictures, the finest first, as in graphics_names */
static const struct gm_graphics ladder[] = {
    {GM_INLINE_KITTY, GM_BRAILLE},  {GM_INLINE_SIXEL, GM_BRAILLE},    {GM_INLINE_NONE, GM_BRAILLE},
    {GM_INLINE_NONE, GM_QUADRANTS}, {GM_INLINE_NONE, GM_HALF_BLOCKS}, {GM_INLINE_NONE, GM_ASCII},
};
enum { RUNGS = GM_COUNT(ladder), FIRST_BLOCKS = 2 };

/* milliseconds; longer than a round trip around the world */
enum { PATIENCE = 1000 };

static int rung_of(struct gm_graphics graphics)
{
    for (int i = 0; i < RUNGS; i++) {
        /* with pixels only the text uses blocks */
        if (ladder[i].pixels == graphics.pixels && (graphics.pixels || ladder[i].blocks == graphics.blocks)) {
            return i;
        }
    }
    return RUNGS - 1;
}

/* Returns the ladder's step for this terminal: beside pixels, text without braille uses half blocks or
   ASCII. */
static struct gm_graphics step_on(const struct gm_terminal *terminal, int rung)
{
    struct gm_graphics graphics = ladder[rung];
    if (!terminal->can_blocks[graphics.blocks] && graphics.pixels) {
        graphics.blocks = terminal->can_blocks[GM_HALF_BLOCKS] ? GM_HALF_BLOCKS : GM_ASCII;
    }
    return graphics;
}

static bool can(const struct gm_terminal *terminal, int rung)
{
    return ladder[rung].pixels ? terminal->can_pixels[ladder[rung].pixels]
                               : terminal->can_blocks[ladder[rung].blocks];
}

struct gm_graphics gm_graphics_next(const struct gm_terminal *terminal, struct gm_graphics graphics)
{
    int from = rung_of(graphics), rung = from;
    do {
        rung = (rung + 1) % RUNGS;
    } while (rung != from && !can(terminal, rung));
    return step_on(terminal, rung);
}

static const char *environment(const char *name)
{
    const char *value = getenv(name);
    return value ? value : "";
}

/* A demand of the user, by an option or else the environment. */
struct demand {
    const char *name, *value; /* value: "" if nothing is demanded */
    int number;               /* index among the names, or -1 */
};

/* Finds a demand. Returns false and fills message if its value is not one of the names. */
static bool find_demand(struct demand *demand, const char *option, const char *given, const char *variable,
                        const char *const *names, char *message)
{
    *demand = (struct demand){given ? option : variable, given ? given : environment(variable), -1};
    if (!*demand->value) {
        return true;
    }
    int count = 0;
    for (; names[count]; count++) {
        if (strcasecmp(demand->value, names[count]) == 0) {
            demand->number = count;
            return true;
        }
    }
    gm_refuse(message, "%s is \"%.40s\", but it must be ", demand->name, demand->value);
    for (int i = 0; i < count; i++) {
        const char *between = i + 2 < count ? ", " : i + 2 == count ? " or " : ".";
        gm_append(message, GM_MESSAGE, "%s%s", names[i], between);
    }
    return false;
}

/* The user's demands on the terminal. */
struct demands {
    struct demand theme, colours, graphics;
};

/* Finds the options' demands and, unless `alone`, those of the environment. */
static bool find_demands(struct demands *demands, const struct gm_overrides *overrides, bool alone,
                         char *message)
{
    return find_demand(&demands->theme, "--theme", overrides->theme, alone ? "" : "GEOMINT_THEME",
                       theme_names, message) &&
           find_demand(&demands->colours, "--colours", overrides->colours, alone ? "" : "GEOMINT_COLOURS",
                       colours_names, message) &&
           find_demand(&demands->graphics, "--graphics", overrides->graphics, alone ? "" : "GEOMINT_GRAPHICS",
                       graphics_names, message);
}

static void because(char *why, const struct demand *demand)
{
    snprintf(why, GM_REASON, "%s%s%.60s", demand->name, demand->name[0] == '-' ? " " : "=", demand->value);
}

void gm_terminal_size(int *columns, int *rows)
{
    struct winsize size = {0};
    if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0 || size.ws_row == 0) {
        size.ws_col = (unsigned short)strtoul(environment("COLUMNS"), NULL, 10);
        size.ws_row = (unsigned short)strtoul(environment("LINES"), NULL, 10);
    }
    *columns = size.ws_col ? size.ws_col : 80;
    *rows = size.ws_row ? size.ws_row : 24;
}

/* ---- asking the terminal ---- */

void gm_terminal_cell(int *width, int *height)
{
    struct winsize size = {0};
    if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col && size.ws_row &&
        size.ws_xpixel >= size.ws_col && size.ws_ypixel >= size.ws_row) {
        *width = size.ws_xpixel / size.ws_col;
        *height = size.ws_ypixel / size.ws_row;
    }
}

static bool begins(const char *text, const char *with)
{
    return strncmp(text, with, strlen(with)) == 0;
}

static void ask(struct gm_terminal *terminal)
{
    terminal->asked = -1;
    if (!terminal->input || !terminal->output || !terminal->known) {
        snprintf(terminal->kitty_why, GM_REASON, "not asked");
        snprintf(terminal->sixel_why, GM_REASON, "not asked");
        return;
    }
    bool tmux = *environment("TMUX") || begins(terminal->name, "tmux");
    bool multiplexer = tmux || begins(terminal->name, "screen");
    bool old = begins(terminal->name, "linux") || begins(terminal->name, "vt");
    /* GNU screen would show some questions as text */
    enum gm_ask which = tmux ? GM_ASK_GROUND : multiplexer || old ? GM_ASK_PLAIN : GM_ASK_ALL;
    terminal->asked =
        gm_answers_ask(&terminal->answers, which, PATIENCE, terminal->typed, &terminal->typed_size);
    const struct gm_answers *answers = &terminal->answers;
    snprintf(terminal->kitty_why, GM_REASON, "%s",
             answers->kitty ? "the terminal answered so"
             : multiplexer  ? "not asked: tmux and screen pass no such images on"
             : old          ? "not asked: such a terminal would show the question"
                            : "the terminal did not confirm it");
    snprintf(terminal->sixel_why, GM_REASON, "%s",
             answers->sixel        ? "among its device attributes"
             : answers->attributes ? "not among its device attributes"
                                   : "the terminal did not answer");
}

static void find_cell(struct gm_terminal *terminal)
{
    const struct gm_answers *answers = &terminal->answers;
    snprintf(terminal->cell_why, GM_REASON, "the system knows it");
    gm_terminal_cell(&terminal->cell_width, &terminal->cell_height);
    if (terminal->cell_width == 0 && answers->cell_width > 0 && answers->cell_height > 0) {
        terminal->cell_width = answers->cell_width;
        terminal->cell_height = answers->cell_height;
        snprintf(terminal->cell_why, GM_REASON, "the terminal answered so");
    } else if (terminal->cell_width == 0 && answers->text_width >= terminal->columns &&
               answers->text_height >= terminal->rows) {
        terminal->cell_width = answers->text_width / terminal->columns;
        terminal->cell_height = answers->text_height / terminal->rows;
        snprintf(terminal->cell_why, GM_REASON, "the terminal reported the size of its text area");
    } else if (terminal->cell_width == 0) {
        snprintf(terminal->cell_why, GM_REASON, "neither the system nor the terminal reports it");
    }
    if (terminal->cell_width > 200 || terminal->cell_height > 400) { /* no font is that large */
        terminal->cell_width = terminal->cell_height = 0;
        snprintf(terminal->cell_why, GM_REASON, "the reported size is impossible");
    }
}

/* ---- decisions ---- */

static void decide_colours(struct gm_terminal *terminal, const struct demand *demand, bool mono)
{
    const char *said = environment("COLORTERM");
    bool says_true = strcasecmp(said, "truecolor") == 0 || strcasecmp(said, "24bit") == 0;
    int has = terminal->terminfo_colours;
    if (mono) {
        terminal->colours = GM_COLOURS_NONE;
        snprintf(terminal->colours_why, GM_REASON, "the theme is monochrome");
    } else if (demand->number >= 0) {
        terminal->colours = (enum gm_colours)demand->number;
        because(terminal->colours_why, demand);
    } else if (*environment("NO_COLOR")) {
        terminal->colours = GM_COLOURS_NONE;
        snprintf(terminal->colours_why, GM_REASON, "NO_COLOR is set");
    } else if (has < 8) {
        /* ssh and su pass COLORTERM on; a TERM without colours is more reliable */
        terminal->colours = GM_COLOURS_NONE;
        snprintf(terminal->colours_why, GM_REASON, "terminfo knows no colours of TERM=%s%s", terminal->name,
                 says_true ? ", whatever COLORTERM says" : "");
    } else if (says_true) {
        terminal->colours = GM_COLOURS_TRUE;
        snprintf(terminal->colours_why, GM_REASON, "COLORTERM=%.60s", said);
    } else if (terminal->answers.true_colour) {
        terminal->colours = GM_COLOURS_TRUE;
        snprintf(terminal->colours_why, GM_REASON, "the terminal kept a colour of 24 bits when it was asked");
    } else {
        terminal->colours = has >= 1 << 24 ? GM_COLOURS_TRUE : has >= 256 ? GM_COLOURS_256 : GM_COLOURS_16;
        snprintf(terminal->colours_why, GM_REASON, "terminfo gives TERM=%s %d colours%s", terminal->name, has,
                 *said ? "" : ", and COLORTERM is not set");
    }
}

static void find_graphics(struct gm_terminal *terminal)
{
    const struct gm_answers *answers = &terminal->answers;
    terminal->can_blocks[GM_ASCII] = true;
    terminal->can_blocks[GM_QUADRANTS] = terminal->can_blocks[GM_HALF_BLOCKS] = terminal->utf8;
    terminal->can_blocks[GM_BRAILLE] = terminal->utf8 && strcmp(terminal->name, "linux") != 0;
    const char *hindrance = terminal->colours == GM_COLOURS_NONE ? "but colours are off"
                            : terminal->cell_width == 0          ? "but the size of a cell is unknown"
                                                                 : NULL;
    if (answers->kitty && hindrance) {
        snprintf(terminal->kitty_why, GM_REASON, "the terminal answered so, %s", hindrance);
    }
    terminal->can_pixels[GM_INLINE_KITTY] = answers->kitty && !hindrance;
    if (answers->registers > 0 && answers->registers < 256 && !hindrance) {
        hindrance = "but of fewer than 256 colours";
    }
    if (answers->sixel && hindrance) {
        snprintf(terminal->sixel_why, GM_REASON, "among its device attributes, %s", hindrance);
    }
    terminal->can_pixels[GM_INLINE_SIXEL] = answers->sixel && !hindrance;
}

static void decide_graphics(struct gm_terminal *terminal, const struct demand *demand)
{
    find_graphics(terminal);
    int rung = 0;
    while (!can(terminal, rung)) {
        rung++;
    }
    if (demand->number >= 0) {
        rung = demand->number;
        because(terminal->graphics_why, demand);
        if (ladder[rung].pixels && terminal->cell_width == 0) {
            terminal->cell_width = 10; /* the cell of the VT340, which its emulators use */
            terminal->cell_height = 20;
            snprintf(terminal->cell_why, GM_REASON, "assumed, as nothing reports it");
        }
        terminal->can_pixels[ladder[rung].pixels] = true;
        terminal->can_blocks[ladder[rung].blocks] |= !ladder[rung].pixels;
    } else if (rung < FIRST_BLOCKS) {
        snprintf(terminal->graphics_why, GM_REASON, "%s",
                 rung == 0 ? terminal->kitty_why : terminal->sixel_why);
    } else if (!terminal->utf8) {
        snprintf(terminal->graphics_why, GM_REASON,
                 "no pixels, and the locale's letters are %.40s, not UTF-8", terminal->codeset);
    } else if (ladder[rung].blocks != GM_BRAILLE) {
        snprintf(terminal->graphics_why, GM_REASON, "the Linux console's font has no braille");
    } else {
        snprintf(terminal->graphics_why, GM_REASON, "no pixels, and the locale's letters are UTF-8");
    }
    terminal->graphics = step_on(terminal, rung);
}

static void decide_theme(struct gm_terminal *terminal, const struct demand *demand)
{
    const struct gm_answers *answers = &terminal->answers;
    /* the value may be "default", which gives no colour */
    const char *said = environment("COLORFGBG"), *ground = strrchr(said, ';');
    bool numbered = ground && ground[1] >= '0' && ground[1] <= '9';
    if (demand->number >= 0) {
        terminal->theme = demand->number == LIGHT ? GM_THEME_LIGHT : GM_THEME_DARK;
        because(terminal->theme_why, demand);
    } else if (numbered) {
        int colour = atoi(ground + 1);
        terminal->theme = colour == 7 || colour >= 9 ? GM_THEME_LIGHT : GM_THEME_DARK;
        snprintf(terminal->theme_why, GM_REASON, "COLORFGBG=%.40s", said);
    } else if (answers->ground_told) {
        terminal->theme = answers->ground > 0.5 ? GM_THEME_LIGHT : GM_THEME_DARK;
        snprintf(terminal->theme_why, GM_REASON, "the terminal answered that its background is %s",
                 answers->ground > 0.5 ? "light" : "dark");
    } else {
        terminal->theme = GM_THEME_DARK;
        snprintf(terminal->theme_why, GM_REASON, "nothing says otherwise");
    }
}

bool gm_terminal_detect(struct gm_terminal *terminal, const struct gm_overrides *overrides, char *message)
{
    *terminal = (struct gm_terminal){
        .name = environment("TERM"), .input = isatty(STDIN_FILENO), .output = isatty(STDOUT_FILENO)};
    /* only the letters: numbers always use a decimal point */
    setlocale(LC_CTYPE, "");
    terminal->codeset = nl_langinfo(CODESET);
    terminal->utf8 = strcasecmp(terminal->codeset, "UTF-8") == 0;
    int error;
    terminal->terminfo_colours = -1;
    if (*terminal->name && gm_curses()->setupterm(terminal->name, STDOUT_FILENO, &error) == OK) {
        terminal->terminfo_colours = gm_curses()->tigetnum("colors");
        const char *address = gm_curses()->tigetstr("cup");
        terminal->known = address && address != (char *)-1;
        gm_curses()->del_curterm(*gm_curses()->cur_term);
    }
    gm_terminal_size(&terminal->columns, &terminal->rows);
    struct winsize size = {0};
    bool asked = ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
    snprintf(terminal->size_why, GM_REASON, "%s",
             asked                     ? "the terminal was asked"
             : *environment("COLUMNS") ? "COLUMNS and LINES"
                                       : "assumed, as there is no terminal to ask");
    struct demands demands;
    if (!find_demands(&demands, overrides, false, message)) {
        return false;
    }
    ask(terminal);
    decide_theme(terminal, &demands.theme);
    decide_colours(terminal, &demands.colours, demands.theme.number == MONO);
    find_cell(terminal);
    decide_graphics(terminal, &demands.graphics);
    terminal->demanded = demands.graphics.number >= 0;
    return true;
}

bool gm_terminal_imagine(struct gm_terminal *terminal, const struct gm_overrides *overrides, char *message)
{
    enum { LEAST_COLUMNS = 20, LEAST_ROWS = 6, MOST_COLUMNS = 400, MOST_ROWS = 120 };
    struct demands demands;
    const char *size = overrides->screen ? overrides->screen : "80x24";
    int used = 0;
    *terminal = (struct gm_terminal){
        .name = "", .input = true, .output = true, .known = true, .utf8 = true, .asked = -1};
    if (sscanf(size, "%5dx%5d%n", &terminal->columns, &terminal->rows, &used) != 2 || size[used] ||
        terminal->columns < LEAST_COLUMNS || terminal->columns > MOST_COLUMNS ||
        terminal->rows < LEAST_ROWS || terminal->rows > MOST_ROWS) {
        return gm_refuse(message, "--screen %.40s is not COLUMNSxROWS from %dx%d to %dx%d", size,
                         LEAST_COLUMNS, LEAST_ROWS, MOST_COLUMNS, MOST_ROWS);
    }
    if (!find_demands(&demands, overrides, true, message)) {
        return false;
    }
    const int colours = demands.colours.number >= 0 ? demands.colours.number : (int)GM_COLOURS_TRUE;
    terminal->theme = demands.theme.number == LIGHT ? GM_THEME_LIGHT : GM_THEME_DARK;
    terminal->colours = demands.theme.number == MONO ? GM_COLOURS_NONE : (enum gm_colours)colours;
    decide_graphics(terminal, &demands.graphics);
    return !terminal->graphics.pixels || gm_refuse(message,
                                                   "--graphics %s needs a terminal; --shot draws braille, "
                                                   "quadrants, half or ascii",
                                                   demands.graphics.value);
}

void gm_terminal_reconsider(struct gm_terminal *terminal)
{
    const struct demand none = {"", "", -1};
    if (!terminal->demanded) {
        find_cell(terminal);
        decide_graphics(terminal, &none);
    }
}

bool gm_terminal_serves(const struct gm_terminal *terminal, char *message)
{
    if (!terminal->input || !terminal->output) {
        return gm_refuse(
            message,
            "the explorer needs a terminal, but standard %s is not one; geomint render makes pictures without",
            terminal->input ? "output" : "input");
    }
    if (!*terminal->name) {
        return gm_refuse(
            message, "the explorer cannot start because TERM is not set; try TERM=xterm-256color geomint");
    }
    const bool known = strcmp(terminal->name, "dumb") == 0 || terminal->terminfo_colours != -1;
    return terminal->known ||
           gm_refuse(
               message,
               "the explorer cannot start because TERM is \"%.40s\", %s; try TERM=xterm-256color geomint",
               terminal->name,
               known ? "which cannot place the cursor"
                     : "which terminfo does not know or which cannot place the cursor");
}

static void line(const char *what, const char *value, const char *why)
{
    printf("  %-12s %-16s %s\n", what, *value ? value : "not set", why);
}

static void report_answers(const struct gm_terminal *terminal)
{
    const struct gm_answers *answers = &terminal->answers;
    char text[64], limit[GM_REASON] = "";
    if (terminal->asked < 0) {
        line("asked", "no", "there is no terminal to ask");
        return;
    }
    snprintf(text, sizeof text, "%d ms", terminal->asked);
    line("asked", text, answers->attributes ? "until it had answered" : "it did not answer");
    line("kitty", answers->kitty ? "yes" : "no", terminal->kitty_why);
    line("sixel", answers->sixel ? "yes" : "no", terminal->sixel_why);
    if (answers->registers > 0 || answers->most_width > 0) {
        if (answers->most_width > 0) {
            snprintf(limit, sizeof limit, "and up to %d x %d pixels at once", answers->most_width,
                     answers->most_height);
        }
        snprintf(text, sizeof text, "%d colours", answers->registers);
        line("", answers->registers > 0 ? text : "any colours", limit);
    }
    line("synchronised", answers->synchronised ? "yes" : "no",
         "whether frames are shown at once (mode 2026)");
}

/* Prints the painter in use, found with a small canvas. */
static void report_painter(const char *what, bool live, const char *where)
{
    char message[GM_MESSAGE];
    enum { SMALL = 64 };
    struct gm_canvas *canvas =
        gm_canvas_open(&(struct gm_appearance){.width = SMALL, .height = SMALL, .live = live}, message);
    if (!gm_memory_was_short()) {
        line(what, canvas ? gm_canvas_backend(canvas) : "none", canvas ? where : message);
    }
    gm_canvas_close(canvas);
}

int gm_terminal_report(const struct gm_overrides *overrides)
{
    struct gm_terminal terminal;
    char message[GM_MESSAGE], text[64];
    if (!gm_terminal_detect(&terminal, overrides, message)) {
        return gm_give_up(GM_EXIT_USAGE, "%s", message);
    }
    printf("Found\n");
    line("TERM", terminal.name, terminal.known ? "terminfo knows it" : "no entry in terminfo that serves");
    line("COLORTERM", environment("COLORTERM"), "");
    snprintf(text, sizeof text, "%d", terminal.terminfo_colours < 0 ? 0 : terminal.terminfo_colours);
    line("terminfo", text, "colours");
    line("locale", terminal.codeset, terminal.utf8 ? "Unicode" : "no Unicode");
    line("tmux", *environment("TMUX") ? "yes" : "no",
         *environment("TMUX") ? "its own terminal settings decide what arrives outside" : "");
    line("input", terminal.input ? "terminal" : "no terminal", "");
    line("output", terminal.output ? "terminal" : "no terminal", "");
    report_painter("painter", true, "in the terminal");
    report_painter("", false, "of PNG files and movies");
    report_answers(&terminal);
    printf("Therefore\n");
    snprintf(text, sizeof text, "%d x %d", terminal.columns, terminal.rows);
    line("size", text, terminal.size_why);
    snprintf(text, sizeof text, "%d x %d", terminal.cell_width, terminal.cell_height);
    line("cell", terminal.cell_width > 0 ? text : "unknown", terminal.cell_why);
    line("colours", colours_names[terminal.colours], terminal.colours_why);
    line("graphics", graphics_names[rung_of(terminal.graphics)], terminal.graphics_why);
    char ways[GM_REASON] = "";
    for (int i = 0; i < RUNGS; i++) {
        if (can(&terminal, i)) {
            gm_append(ways, sizeof ways, "%s%s", ways[0] ? ", " : "", graphics_names[i]);
        }
    }
    printf("  %-12s %s\n", "key b", ways);
    line("theme", theme_names[terminal.theme == GM_THEME_LIGHT ? LIGHT : DARK], terminal.theme_why);
    if (!gm_terminal_serves(&terminal, message)) {
        printf("  %s\n", message);
    }
    printf(
        "Override with --graphics kitty|sixel|braille|quadrants|half|ascii, --colours truecolor|256|16|none,\n"
        "--theme light|dark|mono, or with GEOMINT_GRAPHICS, GEOMINT_COLOURS, GEOMINT_THEME.\n");
    return GM_EXIT_OK;
}
