/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A typed line as words, and its faults. */
#include "app/words/request.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/base/arguments.h"
#include "app/words/names.h"
#include "app/words/system.h"
#include "app/words/words.h"

/* ---- words ---- */

/* A walk through the letters of a line's words. */
struct walk {
    const char *line;
    size_t at; /* offset of the letter */
    int word, depth;
    char quote;
    bool inside;  /* a word has begun */
    bool behind;  /* it follows an equals sign, so blanks mean nothing */
    bool has_key; /* the word has a key */
};

/* Returns true if a word begins here: NAME= or NAME[index]=. */
static bool is_key(const char *text)
{
    size_t length = 0;
    while (isalnum((unsigned char)text[length]) || text[length] == '_') {
        length++;
    }
    if (length > 0 && text[length] == '[') {
        const size_t index = strcspn(text + length, "] ");
        length += index + (text[length + index] == ']');
    }
    return length > 0 && !isdigit((unsigned char)text[0]) && text[length] == '=';
}

/* The next letter of a word; 0 at the end. `walk->at` is then after it. */
static char next_letter(struct walk *walk)
{
    for (char c; (c = walk->line[walk->at]) != '\0';) {
        walk->at++;
        if (walk->quote ? c == walk->quote : c == '\'' || c == '"') {
            walk->quote = walk->quote ? '\0' : c;
            walk->word += !walk->inside;
            walk->inside = true;
            continue;
        }
        if (c == ' ' && !walk->quote) {
            const char *rest = walk->line + walk->at + strspn(walk->line + walk->at, " ");
            const char *plain = rest + (*rest == '\'' || *rest == '"');
            const bool ends = walk->depth <= 0 && (is_key(plain) || !walk->has_key);
            if (ends || *rest == '\0') {
                walk->inside = false;
            }
            if (!walk->inside || walk->behind) {
                walk->at = (size_t)(rest - walk->line);
                continue;
            }
        }
        if (!walk->inside) {
            walk->inside = true;
            walk->word++;
            walk->depth = 0;
            walk->has_key = false;
        }
        walk->depth += (c == '(' || c == '[') - (c == ')' || c == ']');
        walk->behind = c == '=' && !walk->has_key;
        walk->has_key = walk->has_key || c == '=';
        return c;
    }
    return '\0';
}

bool gm_typed_split(struct gm_arguments *words, const char *line)
{
    struct walk walk = {.line = line, .word = -1};
    char *word = malloc(strlen(line) + 1);
    size_t length = 0;
    int number = 0;
    words->failed = words->failed || !word;
    for (char c; !words->failed && (c = next_letter(&walk)) != '\0'; word[length++] = c) {
        if (walk.word != number) {
            word[length] = '\0';
            gm_arguments_add(words, word);
            number = walk.word;
            length = 0;
        }
    }
    if (length > 0) {
        word[length] = '\0';
        gm_arguments_add(words, word);
    }
    free(word);
    return !words->failed;
}

/* The offset, in a line, of a letter of a word. */
static size_t place_of(const char *line, int word, size_t offset)
{
    struct walk walk = {.line = line, .word = -1};
    size_t at = 0; /* the offset after its last letter */
    while (next_letter(&walk) != '\0' && walk.word <= word) {
        if (walk.word == word && offset-- == 0) {
            return walk.at - 1;
        }
        at = walk.at;
    }
    return at;
}

char *gm_typed_join(const struct gm_arguments *words)
{
    struct gm_text_stream writing;
    FILE *stream = gm_stream_begin(&writing);
    for (int i = 0; stream && i < words->count; i++) {
        const char *word = words->words[i], *quote = strchr(word, '\'') ? "\"" : "'";
        struct gm_arguments alone = {0}; /* blanks or quotes may split or change the word */
        const bool same =
            gm_typed_split(&alone, word) && alone.count == 1 && strcmp(alone.words[0], word) == 0;
        gm_arguments_close(&alone);
        quote = same ? "" : quote;
        fprintf(stream, "%s%s%s%s", i > 0 ? " " : "", quote, word, quote);
    }
    return gm_stream_end(&writing);
}

/* ---- the meaning of the words ---- */

/* The words of a line with the scene first, which a formula does not need; `shift`: the number of words
   added, or negative, of leading words of a command line removed. */
static void read_words(struct gm_arguments *words, const char *line, int *shift)
{
    struct gm_arguments typed = {0};
    gm_typed_split(&typed, line);
    int from = typed.count > 0 && strcmp(typed.words[0], "geomint") == 0;
    from += from < typed.count && from > 0 && strcmp(typed.words[from], "tui") == 0;
    *shift = -from;
    if (from == typed.count || strchr(typed.words[from], '=')) {
        gm_arguments_add(words, "system");
        ++*shift;
    }
    for (int i = from; i < typed.count; i++) {
        gm_arguments_add(words, typed.words[i]);
    }
    words->failed = words->failed || typed.failed;
    gm_arguments_close(&typed);
}

/* The first line of a message is the fault; the others show the place. */
static void fail(struct gm_typed_fault *fault, const char *message)
{
    const size_t length = strcspn(message, "\n");
    memcpy(fault->sentence, message, length);
    fault->sentence[length] = '\0';
}

/* Leaves what a scheme lacks: the scheme and the scene are in view, and a command cannot be given here. */
static void shorten(char *sentence)
{
    const char *lacks = strstr(sentence, "it needs "), *command = strstr(sentence, "; geomint list ");
    if (lacks && command > lacks) {
        const size_t length = (size_t)(command - lacks);
        memmove(sentence, lacks, length);
        sentence[length] = '\0';
    }
}

/* The place of a key's value, or, for an unknown key, of the key. */
static struct gm_word_place word_of(const struct gm_arguments *words, const struct gm_scene *scene,
                                    const char *key)
{
    const bool known = gm_scene_parameter(scene, key) || gm_common_key_find(key) || gm_setting_find(key);
    const size_t length = strlen(key);
    for (int i = 1; i < words->count && length > 0; i++) {
        if (strncmp(words->words[i], key, length) == 0 && words->words[i][length] == '=') {
            return (struct gm_word_place){i, known && words->words[i][length + 1] ? length + 1 : 0};
        }
    }
    return (struct gm_word_place){-1, 0};
}

/* The scene that the words name, which `trial` gets if it is made; NULL with a sentence and its place. */
static const struct gm_scene *scene_of(const struct gm_arguments *words, struct gm_system_trial *trial,
                                       struct gm_word_place *place, char *message)
{
    int status;
    if (gm_scene_of_words(words->count, words->words) || !gm_system_is(words->words[0])) {
        place->word = 0;
        return gm_request_scene(words->count, words->words, &status, message);
    }
    gm_system_try(trial, words->count, words->words, message);
    *place = trial->place;
    place->word = trial->status == GM_EXIT_FILE ? 0 : place->word; /* the file's name */
    return trial->scene;
}

bool gm_typed_request(struct gm_request *request, const char *line, size_t schemes,
                      struct gm_typed_fault *fault)
{
    struct gm_request discarded, *made = request ? request : &discarded;
    struct gm_system_trial trial = {0};
    struct gm_arguments words = {0};
    struct gm_word_place place = {-1, 0};
    char message[GM_MESSAGE] = "not enough memory";
    int shift = 0;
    *fault = (struct gm_typed_fault){.at = -1};
    *made = (struct gm_request){0};
    read_words(&words, line, &shift);
    const struct gm_scene *scene = words.failed ? NULL : scene_of(&words, &trial, &place, message);
    const bool read = scene && gm_request_parse_for(made, scene, words.count, words.words, schemes, message);
    if (!read) {
        place = scene ? word_of(&words, scene, made->unfit ? "scheme" : made->refused) : place;
        const char *word = made->unfit && place.word > 0 ? words.words[place.word] : NULL,
                   *unfit = word ? strstr(word, made->unfit->name) : NULL;
        place.offset = unfit ? (size_t)(unfit - word) + made->unfit_offset : place.offset;
        fail(fault, message);
        if (made->unfit) {
            shorten(fault->sentence);
        }
        const bool shown = place.word >= 0 && place.word >= shift;
        fault->at = shown ? (long)place_of(line, place.word - shift, place.offset) : -1;
    } else if (request) {
        gm_system_trial_keep(&trial);
    } else {
        gm_request_close(made);
    }
    gm_arguments_close(&words);
    gm_system_trial_close(&trial);
    return read;
}

bool gm_typed_check(const char *line, struct gm_typed_fault *fault)
{
    return gm_typed_request(NULL, line, 1, fault);
}

/* ---- schemes ---- */

/* The scheme without blanks around it; a key may precede it. malloc'ed. */
static char *scheme_of(const char *line, size_t *begin)
{
    static const char key[] = "scheme=";
    size_t from = strspn(line, " "), to = strlen(line);
    from += strncmp(line + from, key, sizeof key - 1) == 0 ? sizeof key - 1 : 0;
    while (to > from && line[to - 1] == ' ') {
        to--;
    }
    if (to > from + 1 && (line[from] == '\'' || line[from] == '"') && line[to - 1] == line[from]) {
        from++;
        to--;
    }
    *begin = from;
    return strndup(line + from, to - from);
}

bool gm_typed_scheme(const char *line, const struct gm_scheme **kept, struct gm_typed_fault *fault)
{
    size_t begin = 0, at = 0;
    int status;
    char *name = scheme_of(line, &begin), message[GM_MESSAGE] = "not enough memory";
    *fault = (struct gm_typed_fault){.at = -1};
    const bool known = name && (kept ? (*kept = gm_scheme_sought(name, &status, message)) != NULL
                                     : gm_scheme_check(name, &at, message));
    if (!known) {
        fail(fault, message);
        fault->at = kept ? -1 : (long)(begin + at);
    }
    free(name);
    return known;
}

bool gm_typed_check_scheme(const char *line, struct gm_typed_fault *fault)
{
    static const char key[] = " scheme='";
    const size_t scene = strcspn(line, "\n");
    const char *typed = line + scene + (line[scene] == '\n');
    if (!gm_typed_scheme(typed, NULL, fault)) {
        return false;
    }
    size_t begin = 0;
    char *scheme = scheme_of(typed, &begin), *whole = NULL;
    const bool joined = scheme && asprintf(&whole, "%.*s%s%s'", (int)scene, line, key, scheme) > 0;
    const long first = (long)(scene + sizeof key - 1);
    if (!joined) {
        whole = NULL;
        fail(fault, "not enough memory");
    } else if (!gm_typed_check(whole, fault)) {
        fault->at = (long)begin + (fault->at < first ? 0 : fault->at - first);
    }
    free(scheme);
    free(whole);
    return fault->sentence[0] == '\0';
}
