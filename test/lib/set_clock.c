#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdint.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

/*  The time of day is that of the system plus the nanoseconds in the file
    CLOCK_FILE, which may change at any time.  Waits until a time of day follow
    it, as those of the system follow its clock.  */

#define SECOND 1000000000LL

static volatile int64_t none, *offset = &none;

__attribute__((constructor)) static void begin(void)
{ const char *file = getenv("CLOCK_FILE");
  int fd = file ? open(file, O_RDONLY|O_CLOEXEC) : -1;

  if ( fd >= 0 )
  { void *at = mmap(NULL, sizeof(*offset), PROT_READ, MAP_SHARED, fd, 0);

    if ( at != MAP_FAILED )
      offset = at;
    close(fd);
  }
}

static int64_t now(clockid_t clock)
{ struct timespec t;

  syscall(SYS_clock_gettime, clock, &t);
  return t.tv_sec*SECOND + t.tv_nsec + (clock == CLOCK_REALTIME ? *offset : 0);
}

static struct timespec timespec(int64_t ns)
{ return (struct timespec){ .tv_sec = ns/SECOND, .tv_nsec = ns%SECOND };
}

int clock_gettime(clockid_t clock, struct timespec *t)
{ if ( clock != CLOCK_REALTIME )
    return syscall(SYS_clock_gettime, clock, t);
  *t = timespec(now(clock));
  return 0;
}

int gettimeofday(struct timeval *restrict t, void *restrict zone)
{ int64_t ns = now(CLOCK_REALTIME);

  (void)zone;
  t->tv_sec = ns/SECOND;
  t->tv_usec = ns%SECOND/1000;
  return 0;
}

time_t time(time_t *t)
{ time_t seconds = now(CLOCK_REALTIME)/SECOND;

  if ( t )
    *t = seconds;
  return seconds;
}

int pthread_cond_timedwait(pthread_cond_t *restrict cond,
                           pthread_mutex_t *restrict mutex,
                           const struct timespec *restrict until)
{ int64_t end = until->tv_sec*SECOND + until->tv_nsec;

  for(;;)
  { int64_t left = end - now(CLOCK_REALTIME);
    int64_t slice = left < SECOND/100 ? left : SECOND/100;
    struct timespec t;
    int rc;

    if ( left <= 0 )
      slice = 0;
    t = timespec(now(CLOCK_MONOTONIC) + slice);
    rc = pthread_cond_clockwait(cond, mutex, CLOCK_MONOTONIC, &t);
    if ( rc != ETIMEDOUT || end <= now(CLOCK_REALTIME) )
      return rc;
  }
}
