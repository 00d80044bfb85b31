/* Preloaded: as long as the file $FAILING_DISK holds "fsync N" or "write N",
   such calls on regular files fail with errno N. */

#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>

static int fails(const char *call, int fd)
{ const char *name = getenv("FAILING_DISK");
  char what[16];
  int error = 0;
  struct stat st;
  FILE *in;

  if ( !name || fstat(fd, &st) != 0 || !S_ISREG(st.st_mode) )
    return 0;
  if ( !(in = fopen(name, "r")) )
    return 0;
  if ( fscanf(in, "%15s %d", what, &error) != 2 || strcmp(what, call) != 0 )
    error = 0;
  fclose(in);
  if ( error )
    errno = error;
  return error;
}

#define NEXT(Name, Type) ((Type)dlsym(RTLD_NEXT, Name))

int fsync(int fd)
{ return fails("fsync", fd) ? -1 : NEXT("fsync", int(*)(int))(fd);
}

int fdatasync(int fd)
{ return fails("fsync", fd) ? -1 : NEXT("fdatasync", int(*)(int))(fd);
}

ssize_t write(int fd, const void *data, size_t size)
{ return fails("write", fd) ? -1
       : NEXT("write", ssize_t(*)(int, const void*, size_t))(fd, data, size);
}

ssize_t pwrite(int fd, const void *data, size_t size, off_t at)
{ return fails("write", fd) ? -1
       : NEXT("pwrite", ssize_t(*)(int, const void*, size_t, off_t))
           (fd, data, size, at);
}

ssize_t pwrite64(int fd, const void *data, size_t size, off64_t at)
{ return fails("write", fd) ? -1
       : NEXT("pwrite64", ssize_t(*)(int, const void*, size_t, off64_t))
           (fd, data, size, at);
}
