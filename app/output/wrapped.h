/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_OUTPUT_WRAPPED_H
#define GM_APP_OUTPUT_WRAPPED_H

/* Text on standard output, as wide as that is. */

/* Prints text and a newline; between its words, and behind commas in words longer than a line, it goes on in
   further lines that are indented by so many columns, fewer where that would leave no room. `before` columns
   of the first line are filled already, the last with a blank; the text stands behind them, or at the indent
   if that is farther. */
void gm_print_wrapped(const char *text, int before, int indent);

#endif
