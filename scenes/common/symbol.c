/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Names as written in pictures (symbol.h). */
#include "scenes/common/symbol.h"

#include <ctype.h>
#include <string.h>

#include "core/basics.h"

/* The Greek letter of a name of `length` bytes: "lambda" is "λ"; NULL: no letter. */
static const char *greek(const char *name, size_t length)
{
    static const char *const letters[][2] = {
        {"alpha", "α"}, {"beta", "β"},  {"gamma", "γ"}, {"delta", "δ"},  {"eps", "ε"},  {"epsilon", "ε"},
        {"eta", "η"},   {"theta", "θ"}, {"kappa", "κ"}, {"lambda", "λ"}, {"mu", "μ"},   {"nu", "ν"},
        {"xi", "ξ"},    {"rho", "ρ"},   {"sigma", "σ"}, {"tau", "τ"},    {"phi", "φ"},  {"chi", "χ"},
        {"psi", "ψ"},   {"omega", "ω"}, {"pi", "π"},    {"Omega", "Ω"},  {"Delta", "Δ"}};
    for (size_t i = 0; i < GM_COUNT(letters); i++) {
        if (strlen(letters[i][0]) == length && memcmp(letters[i][0], name, length) == 0) {
            return letters[i][1];
        }
    }
    return NULL;
}

const char *gm_key_symbol(const char *key)
{
    const char *letter = greek(key, strlen(key));
    return letter ? letter : strcmp(key, "dt") == 0 ? "Δt" : strcmp(key, "dx") == 0 ? "Δx" : key;
}

static const char *small_letter(char letter, bool above)
{
    static const char *const low[] = {"₀", "₁", "₂", "₃", "₄", "₅", "₆", "₇", "₈", "₉"};
    static const char *const high[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    static const struct {
        char letter;
        const char *text;
    } letters[] = {{'a', "ₐ"}, {'e', "ₑ"}, {'i', "ᵢ"}, {'o', "ₒ"},
                   {'r', "ᵣ"}, {'u', "ᵤ"}, {'v', "ᵥ"}, {'x', "ₓ"}};
    if (letter >= '0' && letter <= '9') {
        return (above ? high : low)[(unsigned)(letter - '0') % 10];
    }
    for (size_t i = 0; i < GM_COUNT(letters) && !above; i++) {
        if (letters[i].letter == letter) {
            return letters[i].text;
        }
    }
    return NULL;
}

/* Returns true if the digits before a place follow a letter. */
static bool is_in_name(const char *text, const char *at)
{
    while (at > text && isdigit((unsigned char)at[-1])) {
        at--;
    }
    return at > text && isalpha((unsigned char)at[-1]);
}

static bool is_function(const char *name, size_t length)
{
    static const char *const names[] = {
#define GM_FUNCTION(name, arity) #name,
#include "core/functions/functions.def"
    };
    size_t i = 0;
    while (i < GM_COUNT(names) && !(strlen(names[i]) == length && memcmp(names[i], name, length) == 0)) {
        i++;
    }
    return i < GM_COUNT(names);
}

/* Returns the length of what stays as it is at this place of a text: a number with its exponent, or the name of
   a called function, whose digits belong to its name. */
static size_t kept_length(const char *text, const char *at)
{
    static const char figures[] = "0123456789";
    size_t length = 0;
    if (isalpha((unsigned char)at[0])) {
        while (isalnum((unsigned char)at[length])) {
            length++;
        }
        return at[length] == '(' && is_function(at, length) ? length : 0;
    }
    length = is_in_name(text, at) ? 0 : strspn(at, figures);
    if (length > 0 && (at[length] == 'e' || at[length] == 'E')) {
        const size_t power = strspn(at + length + 1, figures);
        length += power > 0 ? 1 + power : 0;
    }
    return length;
}

const char *gm_typeset(struct gm_picture *picture, const char *text)
{
    const size_t size = 4 * strlen(text) + 1;
    char *typed = gm_picture_memory(picture, size), *to = typed;
    for (const char *at = text; *at;) {
        size_t letters = 0;
        const size_t kept = kept_length(text, at);
        while (isalpha((unsigned char)at[letters])) {
            letters++;
        }
        const char *put = letters > 0 && kept == 0 ? greek(at, letters) : NULL;
        size_t taken = kept > 0 ? kept : letters > 0 ? letters : 1;
        const bool behind = at > text && (isalnum((unsigned char)at[-1]) || at[-1] == ']');
        if (letters == 0 && (at[0] == '^' || (at[0] == '_' && behind)) &&
            !isalnum((unsigned char)at[1] ? at[2] : 'x') &&
            !(at[2] == '.' && isdigit((unsigned char)at[3]))) {
            put = small_letter(at[1], at[0] == '^');
            taken = put ? 2 : 1;
        } else if (letters == 0 && isdigit((unsigned char)at[0]) && is_in_name(text, at)) {
            put = small_letter(at[0], false);
        } else if (at[0] == '[') {
            const size_t digits = strspn(at + 1, "0123456789");
            if (digits > 0 && at[1 + digits] == ']') {
                for (size_t i = 0; i < digits; i++) {
                    to = stpcpy(to, small_letter(at[1 + i], false));
                }
                at += digits + 2;
                continue;
            }
        } else if (at[0] == '-') {
            put = "−";
        } else if (at[0] == '*') {
            put = " ";
        }
        if (put) {
            to = stpcpy(to, put);
        } else {
            memcpy(to, at, taken);
            to += taken;
        }
        at += taken;
    }
    *to = '\0';
    return typed;
}
