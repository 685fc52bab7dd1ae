/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_TERMINAL_CURSES_H
#define GM_APP_EXPLORER_TERMINAL_CURSES_H

#include <curses.h>
#include <term.h>
#undef columns /* it defines these short names as macros */
#undef lines
#undef set_background
#undef set_foreground

#include "loader/library.h"

/* The functions of ncurses and its terminfo that are in use: gm_curses()->tigetnum(...). */
/* clang-format off */
#define GM_CURSES_NAMES(F) \
    F(beep) F(cbreak) F(clearok) F(cur_term) F(curs_set) F(define_key) F(del_curterm) F(delscreen) F(delwin) \
    F(endwin) F(keypad) F(newpad) F(newterm) F(nodelay) F(noecho) F(nonl) F(noqiflush) F(putp) \
    F(reset_prog_mode) F(resizeterm) F(set_escdelay) F(setupterm) F(stdscr) F(tigetflag) F(tigetnum) \
    F(tigetstr) F(tiparm) F(wgetch) F(wrefresh)
/* clang-format on */
GM_LIBRARY_TABLE(gm_curses, GM_CURSES_NAMES);

#endif
