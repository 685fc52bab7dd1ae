/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Saved runs to go on with, whose incomplete files have any bytes: the first byte chooses the ending, the second the rows
   that a checkpoint counts, then every three bytes say a file, a place and what is written there, or where it ends. The
   run goes on and makes its file, or is refused with a sentence. */
#include <dirent.h>
#include <fcntl.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "app/data/save.h"
#include "app/words/drive.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void require(bool holds)
{
    if (!holds) {
        abort();
    }
}

enum { ROWS = 5, FILES = 8, NAME = 300 };

static char folder[] = "/tmp/fuzz-saved-XXXXXX";

static void empty(const char *path, bool remove)
{
    DIR *entries = opendir(path);
    for (struct dirent *entry; entries && (entry = readdir(entries));) {
        char name[2 * NAME];
        snprintf(name, sizeof name, "%s/%s", path, entry->d_name);
        if (strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0 && unlink(name) != 0) {
            empty(name, true);
        }
    }
    if (entries) {
        closedir(entries);
    }
    if (remove) {
        rmdir(path);
    }
}

static void leave(void)
{
    empty(folder, true);
}

static struct gm_lane *open_lane(void)
{
    static struct gm_request request;
    char message[GM_MESSAGE];
    if (request.count == 0) {
        require(gm_request_parse(&request, 2, (char *[]){(char[]){"kepler"}, (char[]){"scheme=verlet"}}, 1,
                                 message));
        require(mkdtemp(folder) != NULL && atexit(leave) == 0);
    }
    struct gm_lane *lane = gm_request_open_lane(&request, 0, message);
    require(lane != NULL);
    return lane;
}

/* Adds rows to a lane that has `rows`. Returns false with a sentence. */
static bool add_rows(struct gm_save *save, struct gm_run *run, uint64_t rows, char *message)
{
    bool good = gm_save_begin(save, 0, run, &(struct gm_save_size){.rows = rows, .meta = 99}, message);
    for (int i = 0; i < ROWS && good; i++) {
        good = gm_save_row(save, run, message);
        gm_run_advance(run, 1);
    }
    return good;
}

/* Changes the files of the part. */
static void spoil(const char *part, const uint8_t *data, size_t size)
{
    char names[FILES][2 * NAME];
    size_t count = 0;
    DIR *entries = opendir(part);
    require(entries != NULL);
    for (struct dirent *entry; (entry = readdir(entries)) && count < FILES;) {
        if (entry->d_name[0] != '.') {
            snprintf(names[count++], sizeof *names, "%s/%s", part, entry->d_name);
        }
    }
    closedir(entries);
    for (; size >= 3 && count > 0; data += 3, size -= 3) {
        const int file = open(names[data[0] % count], O_RDWR | O_CLOEXEC);
        struct stat found;
        require(file >= 0 && fstat(file, &found) == 0);
        const off_t place = data[1] * (1 + found.st_size / 512);
        require(data[0] & 64 ? ftruncate(file, place) == 0 : pwrite(file, data + 2, 1, place) == 1);
        close(file);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char *const endings[] = {"npz", "csv", "pvd", "xdmf"};
    if (size < 2) {
        return 0;
    }
    char path[NAME], part[NAME + 8], message[GM_MESSAGE] = "";
    struct gm_lane *lane = open_lane();
    snprintf(path, sizeof path, "%s/a.%s", folder, endings[data[0] % 4]);
    snprintf(part, sizeof part, "%s.part", path);
    uint64_t rows = 0;
    struct gm_save *save = gm_save_open(path, 1, false, true, message);
    if (save) { /* not for every ending */
        require(add_rows(save, lane->run, 0, message) && gm_save_sync(save, &rows, message));
        gm_save_keep(save);
        require(gm_save_close(save, false, true, message) && rows == ROWS);
        spoil(part, data + 2, size - 2);
        message[0] = '\0';
        save = gm_save_open(path, 1, true, true, message);
        bool good = save && add_rows(save, lane->run, data[1] % (2 * ROWS), message) &&
                    gm_save_end(save, "{\"scene\":\"kepler\"}", message);
        good = save && gm_save_close(save, good, false, good ? message : (char[GM_MESSAGE]){0}) && good;
        require(good ? access(path, R_OK) == 0 : message[0] && strlen(message) < GM_MESSAGE);
    }
    gm_lane_close(lane);
    empty(folder, false);
    return 0;
}
