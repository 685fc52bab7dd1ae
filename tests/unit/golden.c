/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Golden pictures: pictures as text, compared word by word and number by number (to 1e-6 of a range of about
   one; pixels change with the fonts, this does not).
       golden FILE SCENE [key=value ...]            compares with FILE
       golden --write FILE SCENE [key=value ...]    writes FILE */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/words/drive.h"
#include "tests/common/picture_text.h"

static char *draw(int count, char *words[])
{
    char message[GM_MESSAGE];
    struct gm_request request;
    if (!gm_request_parse(&request, count, words, 3, message)) {
        fprintf(stderr, "%s\n", message);
        exit(1);
    }
    const struct gm_lane **lanes = calloc(request.count, sizeof *lanes);
    for (size_t i = 0; i < request.count; i++) {
        struct gm_lane *lane = gm_request_open_lane(&request, i, message);
        struct gm_drive drive = {.lane = lane, .request = &request, .index = i};
        if (!lane || !gm_drive_to(&drive, request.lanes[i].steps, true, message)) {
            fprintf(stderr, "%s\n", message);
            exit(1);
        }
        lanes[i] = lane;
    }
    struct gm_picture *picture = gm_picture_open();
    gm_lanes_draw(lanes, request.count, picture);
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    test_picture_write(picture, stream);
    fclose(stream);
    gm_picture_close(picture);
    for (size_t i = 0; i < request.count; i++) {
        gm_lane_close((struct gm_lane *)(uintptr_t)lanes[i]);
    }
    free(lanes);
    gm_request_close(&request);
    return text;
}

/* Whether two words agree: the same text, or numbers close to each other. Numbers at round-off agree as
   such. */
static int agree(const char *a, const char *b)
{
    char *a_end = NULL, *b_end = NULL;
    const double x = strtod(a, &a_end), y = strtod(b, &b_end);
    if (a_end == a || *a_end || b_end == b || *b_end) {
        return strcmp(a, b) == 0;
    }
    return fabs(x - y) <= 1e-6 * fmax(1, fmax(fabs(x), fabs(y)));
}

static int compare(char *have, char *want)
{
    char *have_rest = NULL, *want_rest = NULL;
    char *have_line = strtok_r(have, "\n", &have_rest), *want_line = strtok_r(want, "\n", &want_rest);
    for (int line = 1; have_line || want_line; line++) {
        if (!have_line || !want_line) {
            fprintf(stderr, "line %d: one picture ends here\n", line);
            return 1;
        }
        char *have_word_rest = NULL, *want_word_rest = NULL;
        char *h = strtok_r(have_line, " ", &have_word_rest), *w = strtok_r(want_line, " ", &want_word_rest);
        while (h && w && agree(h, w)) {
            h = strtok_r(NULL, " ", &have_word_rest);
            w = strtok_r(NULL, " ", &want_word_rest);
        }
        if (h || w) {
            fprintf(stderr, "line %d: %s, expected %s\n", line, h ? h : "nothing", w ? w : "nothing");
            return 1;
        }
        have_line = strtok_r(NULL, "\n", &have_rest);
        want_line = strtok_r(NULL, "\n", &want_rest);
    }
    return 0;
}

static char *read_file(const char *path)
{
    FILE *file = fopen(path, "r");
    if (!file) {
        perror(path);
        exit(1);
    }
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    for (int c = fgetc(file); c != EOF; c = fgetc(file)) {
        fputc(c, stream);
    }
    fclose(stream);
    fclose(file);
    return text;
}

int main(int argc, char *argv[])
{
    const int write = argc > 1 && strcmp(argv[1], "--write") == 0;
    if (argc < 3 + write) {
        fprintf(stderr, "golden [--write] FILE SCENE [key=value ...]\n");
        return 1;
    }
    char *have = draw(argc - 2 - write, argv + 2 + write);
    if (write) {
        FILE *file = fopen(argv[2], "w");
        const int failed = !file || fputs(have, file) == EOF || fclose(file) != 0;
        free(have);
        return failed;
    }
    char *want = read_file(argv[1]);
    const int status = compare(have, want);
    free(have);
    free(want);
    return status;
}
