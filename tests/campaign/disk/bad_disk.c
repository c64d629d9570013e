/* Loaded before the C library (LD_PRELOAD): a disk that fails at a moment of one's choice. Every call that changes a file
 * below BAD_DISK_ROOT is counted from 1, in the process that was started (its children write nothing of a campaign).
 *   BAD_DISK_KILL=N    call N kills the process before it does anything
 *   BAD_DISK_FAIL=N    call N and all later ones fail: with BAD_DISK_ERROR, a write after half of its bytes
 *   BAD_DISK_LOG=FILE  the calls, a line each, and what every file held when it was synced, as FILE.COUNT:
 *       create INODE PATH, sync INODE COUNT, rename FROM TO, unlink PATH, mkdir PATH, syncdir PATH
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

static long count, kill_at, fail_at;
static int error_number, log_fd = -1;
static pid_t owner;
static char root[PATH_MAX];

__attribute__((constructor)) static void Begin(void) {
  const char *text = getenv("BAD_DISK_ROOT");
  if (text != NULL) snprintf(root, sizeof root, "%s/", text);
  if ((text = getenv("BAD_DISK_KILL")) != NULL) kill_at = atol(text);
  if ((text = getenv("BAD_DISK_FAIL")) != NULL) fail_at = atol(text);
  if ((text = getenv("BAD_DISK_ERROR")) != NULL) error_number = atoi(text);
  if ((text = getenv("BAD_DISK_LOG")) != NULL) {
    log_fd = (int)syscall(SYS_openat, AT_FDCWD, text, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  }
  owner = getpid();
}

/* Below the root, or the root itself. */
static int Mine(const char *path) {
  const size_t size = strlen(root);
  if (size == 0 || getpid() != owner || strncmp(path, root, size - 1) != 0) return 0;
  return path[size - 1] == '/' || path[size - 1] == '\0';
}

static int MineFd(int fd, char *path) {
  char link[64];
  snprintf(link, sizeof link, "/proc/self/fd/%d", fd);
  const ssize_t size = readlink(link, path, PATH_MAX - 1);
  if (size < 0) return 0;
  path[size] = '\0';
  return Mine(path);
}

/* Counts a call; whether it fails. */
static int Fails(void) {
  ++count;
  if (kill_at != 0 && count >= kill_at) kill(getpid(), SIGKILL);
  if (fail_at == 0 || count < fail_at) return 0;
  errno = error_number;
  return 1;
}

static void Log(const char *format, ...) {
  if (log_fd < 0) return;
  char line[3 * PATH_MAX];
  va_list list;
  va_start(list, format);
  const int size = vsnprintf(line, sizeof line, format, list);
  va_end(list);
  syscall(SYS_write, log_fd, line, (size_t)size);
}

static long Inode(int fd) {
  struct stat status;
  return fstat(fd, &status) == 0 ? (long)status.st_ino : -1;
}

static int Opened(const char *path, int flags, mode_t mode) {
  struct stat status;
  const int creates = (flags & O_CREAT) != 0 && Mine(path) && lstat(path, &status) != 0;
  if (creates && Fails()) return -1;
  const int fd = (int)syscall(SYS_openat, AT_FDCWD, path, flags, mode);
  if (creates && fd >= 0) Log("create %ld %s\n", Inode(fd), path);
  return fd;
}

int open(const char *path, int flags, ...) {
  va_list list;
  va_start(list, flags);
  const mode_t mode = (flags & O_CREAT) != 0 ? va_arg(list, mode_t) : 0;
  va_end(list);
  return Opened(path, flags, mode);
}

int open64(const char *path, int flags, ...) {
  va_list list;
  va_start(list, flags);
  const mode_t mode = (flags & O_CREAT) != 0 ? va_arg(list, mode_t) : 0;
  va_end(list);
  return Opened(path, flags, mode);
}

ssize_t write(int fd, const void *bytes, size_t size) {
  char path[PATH_MAX];
  if (MineFd(fd, path) && Fails()) {
    if (size > 1 && count == fail_at) return syscall(SYS_write, fd, bytes, size / 2);
    return -1;
  }
  return syscall(SYS_write, fd, bytes, size);
}

int ftruncate(int fd, off_t size) {
  char path[PATH_MAX];
  /* Giving room back works on a full disk, and on a broken one nothing does. */
  if (MineFd(fd, path) && Fails() && error_number != ENOSPC) return -1;
  return (int)syscall(SYS_ftruncate, fd, size);
}

static int Synced(int fd, long call) {
  char path[PATH_MAX];
  if (!MineFd(fd, path)) return (int)syscall(call, fd);
  struct stat status;
  if (Fails()) return -1;
  if (log_fd >= 0 && fstat(fd, &status) == 0) {
    if (S_ISDIR(status.st_mode)) {
      Log("syncdir %s\n", path);
    } else {
      char copy[PATH_MAX], bytes[65536];
      snprintf(copy, sizeof copy, "%s.%ld", getenv("BAD_DISK_LOG"), count);
      const int from = (int)syscall(SYS_openat, AT_FDCWD, path, O_RDONLY | O_CLOEXEC, 0);
      const int to = (int)syscall(SYS_openat, AT_FDCWD, copy, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
      for (ssize_t got; (got = read(from, bytes, sizeof bytes)) > 0;) syscall(SYS_write, to, bytes, (size_t)got);
      close(from);
      close(to);
      Log("sync %ld %ld\n", (long)status.st_ino, count);
    }
  }
  return (int)syscall(call, fd);
}

int fsync(int fd) { return Synced(fd, SYS_fsync); }
int fdatasync(int fd) { return Synced(fd, SYS_fdatasync); }

int rename(const char *from, const char *to) {
  if (Mine(to) && Fails()) return -1;
  const int result = (int)syscall(SYS_rename, from, to);
  if (result == 0 && Mine(to)) Log("rename %s %s\n", from, to);
  return result;
}

int unlink(const char *path) {
  const int mine = Mine(path);
  if (mine && Fails() && error_number != ENOSPC) return -1;
  const int result = (int)syscall(SYS_unlink, path);
  if (result == 0 && mine) Log("unlink %s\n", path);
  return result;
}

int mkdir(const char *path, mode_t mode) {
  if (Mine(path) && Fails()) return -1;
  const int result = (int)syscall(SYS_mkdir, path, mode);
  if (result == 0 && Mine(path)) Log("mkdir %s\n", path);
  return result;
}
