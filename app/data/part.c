/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A file in the making: columns that grow in a folder beside it. */
#include "app/data/part.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "app/output/folder.h"
#include "render/message.h"

enum { BUFFER = GM_COLUMN_BUFFER, NAME = 48 };

struct gm_part {
    char *path;
    int folder; /* open, and locked as long as this process lives */
};

static void empty(const struct gm_part *part)
{
    DIR *entries = opendir(part->path);
    const struct dirent *entry = NULL;
    while (entries && (entry = readdir(entries))) {
        if (strncmp(entry->d_name, "column-", strlen("column-")) == 0) {
            unlinkat(part->folder, entry->d_name, 0);
        }
    }
    if (entries) {
        closedir(entries);
    }
}

/* Opens the folder and takes the lock; a folder that its last holder removed meanwhile is none. */
static bool hold(struct gm_part *part, bool *held)
{
    struct stat mine, there;
    *held = false;
    part->folder = open(part->path, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (part->folder < 0) {
        return false;
    }
    if (flock(part->folder, LOCK_EX | LOCK_NB) != 0) {
        *held = errno == EWOULDBLOCK;
        return false;
    }
    errno = ENOENT;
    return fstat(part->folder, &mine) == 0 && stat(part->path, &there) == 0 && mine.st_ino == there.st_ino &&
           mine.st_dev == there.st_dev;
}

struct gm_part *gm_part_open(const char *path, bool go_on, char *message)
{
    struct gm_part *part = calloc(1, sizeof *part);
    if (!part || asprintf(&part->path, "%s.part", path) < 0) {
        free(part);
        gm_refuse(message, "not enough memory");
        return NULL;
    }
    part->folder = -1;
    bool held = false;
    const bool there = go_on || gm_folder_make(part->path, message);
    if (there && hold(part, &held)) {
        if (!go_on) {
            empty(part);
        }
        return part;
    }
    if (held) {
        gm_refuse(message, "%.300s is being written by another process", path);
    } else if (go_on && errno == ENOENT) {
        gm_refuse(message, "%.200s.part is not there: what was saved before cannot be gone on with", path);
    } else if (there) {
        gm_refuse(message, "%.300s.part could not be opened: %s", path, strerror(errno));
    }
    gm_part_close(part, false);
    return NULL;
}

void gm_part_close(struct gm_part *part, bool remove)
{
    if (!part) {
        return;
    }
    if (remove) {
        empty(part);
        rmdir(part->path);
    }
    if (part->folder >= 0) {
        close(part->folder);
    }
    free(part->path);
    free(part);
}

static void name_of(char name[NAME], size_t lane, size_t index)
{
    snprintf(name, NAME, "column-%zu-%zu", lane, index);
}

/* How many bytes the first `rows` lines have; false if there are not so many. */
static bool measure_lines(int file, uint64_t rows, off_t *size)
{
    char block[1 << 14];
    *size = 0;
    while (rows > 0) {
        const ssize_t got = pread(file, block, sizeof block, *size);
        if (got <= 0) {
            return false;
        }
        ssize_t at = 0;
        while (at < got && rows > 0) {
            rows -= block[at++] == '\n';
        }
        *size += at;
    }
    return true;
}

bool gm_column_open(const struct gm_part *part, size_t lane, size_t index, uint64_t rows, size_t row_size,
                    struct gm_column *column)
{
    char name[NAME];
    struct stat status;
    name_of(name, lane, index);
    *column = (struct gm_column){.buffer = malloc(BUFFER)};
    column->file = openat(part->folder, name, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    bool good = column->buffer && column->file >= 0 && fstat(column->file, &status) == 0;
    if (good) {
        off_t size = (off_t)(rows * row_size);
        if (row_size > 0 ? size > status.st_size : !measure_lines(column->file, rows, &size)) {
            errno = EILSEQ;
            good = false;
        }
        good = good && ftruncate(column->file, size) == 0 && lseek(column->file, size, SEEK_SET) == size;
    }
    if (!good) {
        const int why = errno;
        if (column->file >= 0) {
            close(column->file);
        }
        free(column->buffer);
        column->buffer = NULL;
        errno = why;
    }
    return good;
}

static bool write_all(int file, const unsigned char *bytes, size_t size)
{
    while (size > 0) {
        const ssize_t done = write(file, bytes, size);
        if (done < 0 && errno == EINTR) {
            continue;
        }
        if (done <= 0) {
            return false;
        }
        bytes += done;
        size -= (size_t)done;
    }
    return true;
}

bool gm_column_flush(struct gm_column *column, bool sync)
{
    const size_t used = column->used;
    column->used = 0;
    return write_all(column->file, column->buffer, used) && (!sync || fsync(column->file) == 0);
}

bool gm_column_put_full(struct gm_column *column, const void *bytes, size_t size)
{
    if (!gm_column_flush(column, false)) {
        return false;
    }
    if (size > BUFFER) {
        return write_all(column->file, bytes, size);
    }
    memcpy(column->buffer + column->used, bytes, size);
    column->used += size;
    return true;
}

bool gm_column_print(struct gm_column *column, const char *format, ...)
{
    char text[512];
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    return length >= 0 && (size_t)length < sizeof text && gm_column_put(column, text, (size_t)length);
}

bool gm_column_close(struct gm_column *column)
{
    if (!column->buffer) {
        return true;
    }
    bool good = gm_column_flush(column, false);
    good = close(column->file) == 0 && good;
    free(column->buffer);
    column->buffer = NULL;
    return good;
}

int gm_column_read(const struct gm_part *part, size_t lane, size_t index)
{
    char name[NAME];
    name_of(name, lane, index);
    return openat(part->folder, name, O_RDONLY | O_CLOEXEC);
}

bool gm_column_copy(const struct gm_part *part, size_t lane, size_t index, FILE *file)
{
    char block[1 << 16];
    const int source = gm_column_read(part, lane, index);
    ssize_t got = 0;
    bool good = source >= 0;
    while (good && (got = read(source, block, sizeof block)) > 0) {
        good = fwrite(block, 1, (size_t)got, file) == (size_t)got;
    }
    if (source >= 0) {
        close(source);
    }
    return good && got == 0;
}
