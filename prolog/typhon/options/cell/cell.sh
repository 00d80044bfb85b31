#!/bin/bash
# cell.sh LIBRARY FILTER HOME SWIPL ARG...
#
# Run SWIPL with these arguments in a cell, where its standard input and output
# are all that it shares with others:
#   LIBRARY  the folder seen read-only as /typhon
#   FILTER   the compiled seccomp filter that filter.py writes
#   HOME     the home of SWI-Prolog, seen read-only where it is
# CELL_UID, CELL_AS, CELL_NPROC, CELL_TMP and CELL_CPU are limits, see below.
set -eu
# The weight of the nice value 10 is 110, that of 0 is 1024: a cell takes little
# from the host, and beside eight busy processes on two processors it gets 1/38
# of one. Where each session has its own share of the processors (autogroup) the
# value of the session counts, elsewhere that of the process. /proc is read-only
# in the cell, so it cannot change its session. The kernel may accept one change
# in a tenth of a second.
read -r _ _ _ _ _ session _ </proc/$$/stat
if [ "$session" != $$ ]; then exec setsid bash "$0" "$@"; fi
if [ -w /proc/self/autogroup ]; then
    for _ in {1..50}; do
        if echo 10 2>/dev/null >/proc/self/autogroup; then break; fi
        sleep 0.1
    done
fi
library=$1 filter=$2 home=$3 swipl=$4
seen=${CELL_SEEN:-}
# Limits of the number of threads do not hold for root, so a process of root
# gives each cell a user of its own. That one may not enter folders of root, so
# what is in these is mounted elsewhere, for this process alone.
as=() uid=${CELL_UID:-65534} from=("$library" "$home" "$swipl")
if [ "$(id -u)" = 0 ]; then
    as=(setpriv "--reuid=$uid" "--regid=$uid" --clear-groups)
    if [ -n "$seen" ]; then
        mount -t tmpfs -o mode=755 none "$seen"
        mkdir "$seen/library" "$seen/home"
        touch "$seen/swipl"
        mount --bind "$library" "$seen/library"
        mount --bind "$home" "$seen/home"
        mount --bind "$swipl" "$seen/swipl"
        from=("$seen/library" "$seen/home" "$seen/swipl")
    elif ! "${as[@]}" test -r "$library" -a -r "$home" -a -r "$swipl"; then
        CELL_SEEN=/mnt exec unshare --mount bash "$0" "$@"
    fi
fi
shift 4
# Of the system there is what the loader needs: no shell, no Python.
mounts=(--symlink usr/lib /lib --symlink usr/bin /bin
        --ro-bind /usr/bin/prlimit /usr/bin/prlimit)
for path in /usr/lib/*-linux-gnu* /usr/lib64 /etc/ld.so.cache /etc/swi-prolog; do
    if [ -e "$path" ]; then mounts+=(--ro-bind "$path" "$path"); fi
done
if [ -e /lib64 ]; then mounts+=(--symlink usr/lib64 /lib64); fi
mounts+=(--ro-bind "${from[0]}" /typhon --ro-bind "${from[1]}" "$home"
         --ro-bind "${from[2]}" "$swipl")
# SWI-Prolog may have been moved since it was built.
libs=$home/lib/$(basename "$(dirname "$swipl")")
# --unshare-user: --unshare-all alone goes on silently without that.
# --as-pid-1: else process 1 is a bwrap without the limits below, and the cell
# can write to its memory. Signals from inside do not end process 1.
# --perms: a file is some kilobytes of the kernel, whatever its size, so in /tmp
# there are two, and no more can be made: chmod is refused.
# --args: arguments of process 1 can be read inside.
exec 8< <(printf '%s\0' --unshare-all --unshare-user --disable-userns \
    --die-with-parent --as-pid-1 --hostname cell \
    --uid 1000 --gid 1000 --cap-drop ALL --clearenv \
    --setenv PATH /usr/bin --setenv HOME /tmp --setenv LANG C.UTF-8 \
    --setenv LD_LIBRARY_PATH "$libs" \
    --proc /proc --remount-ro /proc --dev /dev --remount-ro /dev \
    --perms 0555 --size "${CELL_TMP:-16777216}" --tmpfs /tmp \
    --perms 0600 --file 6 /tmp/policy --perms 0600 --file 7 /tmp/services.pl \
    "${mounts[@]}" --remount-ro / \
    --chdir /tmp --seccomp 9) 9<"$filter" 6</dev/null 7</dev/null
# bwrap closes no descriptors, and SWI-Prolog 9.0.4 lets processes inherit
# listening sockets. bash keeps one at 63.
for path in /proc/self/fd/*; do
    case ${path##*/} in
    0|1|2|6|7|8|9) ;;
    *) eval "exec ${path##*/}>&-" 2>/dev/null || true ;;
    esac
done
# SCHED_BATCH: it does not interrupt others when it wakes up.
exec nice -n 10 chrt --batch 0 "${as[@]}" bwrap --args 8 -- \
    prlimit --as="${CELL_AS:-1500000000}" --nproc="${CELL_NPROC:-64}" \
        --nofile=64 --fsize=16777216 --core=0 --msgqueue=0 --memlock=0 \
        --rttime=0 --cpu="${CELL_CPU:-unlimited}" --nice=0 --sigpending=64 \
    "$swipl" "$@"
