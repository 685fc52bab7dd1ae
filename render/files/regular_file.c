/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Opening files to read: regular files alone. */
#include "render/files/regular_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

void (*gm_regular_watch)(const char *path);

static void explain(char *reason, int error)
{
    snprintf(reason, GM_REGULAR_REASON, "%s", strerror(error));
}

static bool check(const struct stat *status, size_t most, char *reason)
{
    if (S_ISDIR(status->st_mode)) {
        explain(reason, EISDIR);
        return false;
    }
    if (!S_ISREG(status->st_mode)) {
        snprintf(reason, GM_REGULAR_REASON, "it is a %s, and no file",
                 S_ISFIFO(status->st_mode) ? "pipe" : "device");
        return false;
    }
    if ((unsigned long long)status->st_size > most) {
        const unsigned long long megabyte = 1 << 20;
        snprintf(reason, GM_REGULAR_REASON, "it has %.6g MB, more than %.6g",
                 (double)status->st_size / (double)megabyte, (double)most / (double)megabyte);
        return false;
    }
    return true;
}

FILE *gm_regular_open(const char *path, size_t most, size_t *size, char *reason)
{
    struct stat status;
    /* checked first, because opening a device can already move it; opened without waiting, because it may
       have become a pipe since */
    if (stat(path, &status) != 0) {
        explain(reason, errno);
        return NULL;
    }
    if (!check(&status, most, reason)) {
        return NULL;
    }
    const int descriptor = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    if (descriptor < 0 || fstat(descriptor, &status) != 0) {
        explain(reason, errno);
    } else if (check(&status, most, reason)) {
        FILE *file = fdopen(descriptor, "rb");
        if (file) {
            *size = (size_t)status.st_size;
            if (gm_regular_watch) {
                gm_regular_watch(path);
            }
            return file;
        }
        explain(reason, errno);
    }
    if (descriptor >= 0) {
        close(descriptor);
    }
    return NULL;
}

char *gm_regular_read(const char *path, size_t most, size_t *size, char *reason)
{
    size_t length = 0;
    FILE *file = gm_regular_open(path, most, &length, reason);
    if (!file) {
        return NULL;
    }
    char *bytes = malloc(length + 1);
    errno = bytes ? 0 : ENOMEM;
    if (bytes && fread(bytes, 1, length, file) == length) {
        bytes[length] = '\0';
        *size = length;
    } else {
        if (errno) {
            explain(reason, errno);
        } else {
            snprintf(reason, GM_REGULAR_REASON, "it became shorter while it was read");
        }
        free(bytes);
        bytes = NULL;
    }
    fclose(file);
    return bytes;
}
