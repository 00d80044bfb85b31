"""filter.py FILE: write the seccomp filter of cells for this machine.

What is not listed is refused (EPERM). clone3 is said not to exist, so that
libc takes clone, whose flags a filter can see: threads, and no process and no
namespace. libseccomp.so.2 is part of every Debian; no compiler is needed.
"""
import ctypes
import sys

ALLOWED = """
accept access arch_prctl bind brk clock_getres clock_gettime clock_nanosleep
close connect dup dup2 dup3 epoll_create1 epoll_ctl epoll_pwait epoll_wait
eventfd2 execve exit exit_group faccessat faccessat2 fcntl fdatasync fgetxattr
flock fstat fstatfs fsync ftruncate futex getcwd getdents64 getegid geteuid
getgid getpeername getpgrp getpid getppid getpriority getrandom getresgid
getresuid getrlimit getrusage getsockname getsockopt gettid gettimeofday getuid
getxattr ioctl kill lgetxattr listen lseek lstat madvise membarrier mmap
mprotect mremap munmap nanosleep newfstatat open openat pipe pipe2 poll ppoll
pread64 prlimit64 pselect6 pwrite64 read readlink readlinkat readv recvfrom
recvmsg restart_syscall rseq rt_sigaction rt_sigpending rt_sigprocmask
rt_sigreturn rt_sigsuspend rt_sigtimedwait sched_getaffinity sched_yield select
sendmsg sendto set_robust_list set_tid_address setitimer setsockopt shutdown
sigaltstack stat statfs statx sysinfo tgkill time umask uname wait4 waitid
write writev
""".split()  # not: ptrace keyctl io_uring userfaultfd bpf perf unshare mount

SOCKETS = (1, 2)  # AF_UNIX; AF_INET, which has only the loopback of the cell
PRCTL = (15, 16, 38, 22)  # PR_SET_NAME, PR_GET_NAME, NO_NEW_PRIVS, SECCOMP
CLONE_THREAD, CLONE_NEW = 0x10000, 0x7E020000
EQ, MASKED_EQ = 4, 7
ALLOW, ERRNO, EPERM, ENOSYS = 0x7FFF0000, 0x00050000, 1, 38


class Comparison(ctypes.Structure):
    _fields_ = [("arg", ctypes.c_uint), ("op", ctypes.c_int),
                ("a", ctypes.c_uint64), ("b", ctypes.c_uint64)]


LIB = ctypes.CDLL("libseccomp.so.2")
LIB.seccomp_init.restype = ctypes.c_void_p
LIB.seccomp_rule_add_array.argtypes = [
    ctypes.c_void_p, ctypes.c_uint32, ctypes.c_int, ctypes.c_uint,
    ctypes.POINTER(Comparison)]
LIB.seccomp_export_bpf.argtypes = [ctypes.c_void_p, ctypes.c_int]


def rule(context, action, name, *comparisons):
    number = LIB.seccomp_syscall_resolve_name(name.encode())
    if number == -1:
        sys.exit("no such system call: " + name)
    array = (Comparison * max(1, len(comparisons)))(*comparisons)
    failed = LIB.seccomp_rule_add_array(context, action, number,
                                        len(comparisons), array)
    # A negative number is a call that this machine does not have.
    if failed < 0 and number >= 0:
        sys.exit("%s: %d" % (name, failed))


def main(path):
    context = LIB.seccomp_init(ERRNO | EPERM)
    for name in ALLOWED:
        rule(context, ALLOW, name)
    for family in SOCKETS:
        rule(context, ALLOW, "socket", Comparison(0, EQ, family, 0))
    for option in PRCTL:
        rule(context, ALLOW, "prctl", Comparison(0, EQ, option, 0))
    rule(context, ALLOW, "clone", Comparison(
        0, MASKED_EQ, CLONE_NEW | CLONE_THREAD, CLONE_THREAD))
    rule(context, ERRNO | ENOSYS, "clone3")
    with open(path, "wb") as out:
        LIB.seccomp_export_bpf(context, out.fileno())


main(sys.argv[1])
