/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "app/explorer/terminal.h"

#include <curses.h>
#include <langinfo.h>
#include <locale.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/ioctl.h>
#include <term.h>
#include <unistd.h>

#include "app/request.h"

#undef columns /* term.h defines these short names as macros */
#undef lines

static const char *const colours_names[] = {"none", "16", "256", "truecolor", NULL};
static const char *const blocks_names[] = {"braille", "quadrants", "half", "ascii", NULL};
static const char *const theme_names[] = {"light", "dark", NULL};

const char *gm_blocks_name(enum gm_blocks blocks)
{
    return blocks_names[blocks];
}

static const char *environment(const char *name)
{
    const char *value = getenv(name);
    return value ? value : "";
}

/* The number of an override's value among its names; -1 if it is not set, -2 with a sentence if unknown. */
static int override_of(const char *name, const char *const *names, char *message)
{
    const char *value = environment(name);
    if (!*value) {
        return -1;
    }
    int count = 0;
    for (; names[count]; count++) {
        if (strcasecmp(value, names[count]) == 0) {
            return count;
        }
    }
    int at = snprintf(message, GM_MESSAGE, "%s is \"%.40s\", but it must be ", name, value);
    for (int i = 0; i < count; i++) {
        at += snprintf(message + at, (size_t)(GM_MESSAGE - at), "%s%s",
                       i == 0          ? ""
                       : i + 1 < count ? ", "
                                       : " or ",
                       names[i]);
    }
    snprintf(message + at, (size_t)(GM_MESSAGE - at), ".");
    return -2;
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

static void look_at_terminfo(struct gm_terminal *terminal)
{
    int error;
    terminal->terminfo_colours = -1;
    if (!*terminal->name || setupterm(terminal->name, STDOUT_FILENO, &error) != OK) {
        return;
    }
    terminal->terminfo_colours = tigetnum("colors");
    const char *address = tigetstr("cup");
    terminal->known = address && address != (char *)-1;
    del_curterm(cur_term);
}

static bool decide_colours(struct gm_terminal *terminal, char *message)
{
    const char *said = environment("COLORTERM");
    bool says_true = strcasecmp(said, "truecolor") == 0 || strcasecmp(said, "24bit") == 0;
    int chosen = override_of("GEOMINT_COLOURS", colours_names, message);
    if (chosen == -2) {
        return false;
    }
    int has = terminal->terminfo_colours;
    if (chosen >= 0) {
        terminal->colours = (enum gm_colours)chosen;
        snprintf(terminal->colours_why, GM_REASON, "GEOMINT_COLOURS=%s", colours_names[chosen]);
    } else if (*environment("NO_COLOR")) {
        terminal->colours = GM_COLOURS_NONE;
        snprintf(terminal->colours_why, GM_REASON, "NO_COLOR is set");
    } else if (has < 8) {
        /* COLORTERM is inherited through ssh and su; a TERM that was set to a terminal without colours knows
           better. */
        terminal->colours = GM_COLOURS_NONE;
        snprintf(terminal->colours_why, GM_REASON, "terminfo knows no colours of TERM=%s%s", terminal->name,
                 says_true ? ", whatever COLORTERM says" : "");
    } else if (says_true) {
        terminal->colours = GM_COLOURS_TRUE;
        snprintf(terminal->colours_why, GM_REASON, "COLORTERM=%s", said);
    } else {
        terminal->colours = has >= 1 << 24 ? GM_COLOURS_TRUE : has >= 256 ? GM_COLOURS_256 : GM_COLOURS_16;
        snprintf(terminal->colours_why, GM_REASON, "terminfo gives TERM=%s %d colours%s", terminal->name, has,
                 *said ? "" : ", and COLORTERM is not set");
    }
    return true;
}

static bool decide_blocks(struct gm_terminal *terminal, char *message)
{
    int chosen = override_of("GEOMINT_BLOCKS", blocks_names, message);
    if (chosen == -2) {
        return false;
    }
    if (chosen >= 0) {
        terminal->blocks = (enum gm_blocks)chosen;
        snprintf(terminal->blocks_why, GM_REASON, "GEOMINT_BLOCKS=%s", blocks_names[chosen]);
    } else if (!terminal->utf8) {
        terminal->blocks = GM_ASCII;
        snprintf(terminal->blocks_why, GM_REASON, "the locale's letters are %.40s, not UTF-8",
                 terminal->codeset);
    } else if (strcmp(terminal->name, "linux") == 0) {
        terminal->blocks = GM_HALF_BLOCKS;
        snprintf(terminal->blocks_why, GM_REASON, "the Linux console's font has no braille");
    } else {
        terminal->blocks = GM_BRAILLE;
        snprintf(terminal->blocks_why, GM_REASON, "the locale's letters are UTF-8");
    }
    return true;
}

static bool decide_theme(struct gm_terminal *terminal, char *message)
{
    int chosen = override_of("GEOMINT_THEME", theme_names, message);
    if (chosen == -2) {
        return false;
    }
    const char *said = environment("COLORFGBG"), *ground = strrchr(said, ';');
    if (chosen >= 0) {
        terminal->theme = chosen == 0 ? GM_THEME_LIGHT : GM_THEME_DARK;
        snprintf(terminal->theme_why, GM_REASON, "GEOMINT_THEME=%s", theme_names[chosen]);
    } else if (ground) {
        int colour = atoi(ground + 1);
        terminal->theme = colour == 7 || colour >= 9 ? GM_THEME_LIGHT : GM_THEME_DARK;
        snprintf(terminal->theme_why, GM_REASON, "COLORFGBG=%.40s", said);
    } else {
        terminal->theme = GM_THEME_DARK;
        snprintf(terminal->theme_why, GM_REASON, "nothing says otherwise");
    }
    return true;
}

bool gm_terminal_detect(struct gm_terminal *terminal, char *message)
{
    *terminal = (struct gm_terminal){
        .name = environment("TERM"), .input = isatty(STDIN_FILENO), .output = isatty(STDOUT_FILENO)};
    /* Only the letters: numbers are read and written with a point everywhere. */
    setlocale(LC_CTYPE, "");
    terminal->codeset = nl_langinfo(CODESET);
    terminal->utf8 = strcasecmp(terminal->codeset, "UTF-8") == 0;
    look_at_terminfo(terminal);
    gm_terminal_size(&terminal->columns, &terminal->rows);
    struct winsize size = {0};
    bool asked = ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
    snprintf(terminal->size_why, GM_REASON, "%s",
             asked                     ? "the terminal was asked"
             : *environment("COLUMNS") ? "COLUMNS and LINES"
                                       : "assumed, as there is no terminal to ask");
    return decide_colours(terminal, message) && decide_blocks(terminal, message) &&
           decide_theme(terminal, message);
}

bool gm_terminal_serves(const struct gm_terminal *terminal, char *message)
{
    if (!terminal->input || !terminal->output) {
        snprintf(
            message, GM_MESSAGE,
            "The explorer needs a terminal, but standard %s is none; `geomint render` makes pictures without.",
            terminal->input ? "output" : "input");
    } else if (!*terminal->name) {
        snprintf(message, GM_MESSAGE,
                 "The explorer cannot start because TERM is not set; try TERM=xterm-256color geomint.");
    } else if (!terminal->known) {
        snprintf(message, GM_MESSAGE,
                 "The explorer cannot start because TERM is \"%.40s\", %s; try TERM=xterm-256color geomint.",
                 terminal->name,
                 strcmp(terminal->name, "dumb") == 0 || terminal->terminfo_colours != -1
                     ? "which cannot place the cursor"
                     : "which terminfo does not know or which cannot place the cursor");
    } else {
        return true;
    }
    return false;
}

static void line(const char *what, const char *value, const char *why)
{
    printf("  %-10s %-16s %s\n", what, *value ? value : "not set", why);
}

int gm_terminal_report(void)
{
    struct gm_terminal terminal;
    char message[GM_MESSAGE], text[64];
    if (!gm_terminal_detect(&terminal, message)) {
        fprintf(stderr, "geomint: %s\n", message);
        return GM_EXIT_USAGE;
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
    printf("Therefore\n");
    snprintf(text, sizeof text, "%d x %d", terminal.columns, terminal.rows);
    line("size", text, terminal.size_why);
    line("colours", colours_names[terminal.colours], terminal.colours_why);
    line("blocks", blocks_names[terminal.blocks], terminal.blocks_why);
    line("theme", terminal.theme == GM_THEME_LIGHT ? "light" : "dark", terminal.theme_why);
    if (!gm_terminal_serves(&terminal, message)) {
        printf("  %s\n", message);
    }
    printf(
        "Override with GEOMINT_COLOURS=truecolor|256|16|none, GEOMINT_BLOCKS=braille|quadrants|half|ascii,\n"
        "GEOMINT_THEME=light|dark.\n");
    return GM_EXIT_OK;
}
