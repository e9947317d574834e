#!/bin/bash
# Process 1 of the guest: makes vcan0 and vcan1, runs the job, hands out its exit code, powers off.
#
# The root file system is the host's own tree, writable, so this script must never get as far as
# its mounts and its power-off anywhere but in the guest. `cargo xtask vcan` copies it into the job
# folder, which the kernel passes in XT28_JOB.
set -u
if [ "$$" -ne 1 ] || [[ "$(uname -r)" != *-xt28-guest ]] || [ -z "${XT28_JOB:-}" ]; then
    echo "init.sh: only for process 1 of the xt28 guest; nothing done" >&2
    exit 1
fi
export PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin

mount -t devtmpfs devices /dev
mkdir -p /dev/pts /dev/shm
mount -t devpts -o ptmxmode=666 terminals /dev/pts
mount -t tmpfs memory /dev/shm
mount -t proc processes /proc
mount -t sysfs kernel /sys
mount -t tmpfs run /run
ln -sf /proc/self/fd /dev/fd

# Console 0 is the job's stdout, console 1 its stderr. Raw: no carriage returns added.
stty -F /dev/tty0 raw -echo
stty -F /dev/tty1 raw -echo
exec </dev/null >/dev/tty1 2>&1

ip link set lo up
for bus in vcan0 vcan1; do
    # 72 bytes is one CAN FD frame; stated, for the default differs between kernels.
    ip link add dev "$bus" type vcan && ip link set "$bus" mtu 72 up || {
        echo "init.sh: no $bus in this guest"
        echo 125 >"$XT28_JOB/status"
    }
done

# Through pipes, so that the job sees no terminal and draws no progress bar.
mkfifo /run/out /run/err
cat /run/out >/dev/tty0 &
out=$!
cat /run/err >/dev/tty1 &
err=$!
if [ ! -e "$XT28_JOB/status" ]; then
    bash "$XT28_JOB/job.sh" </dev/null >/run/out 2>/run/err
    status=$?
    # Whatever the job left behind ends with it; its open pipes would keep the guest up for ever.
    for process in /proc/[0-9]*; do
        process=${process#/proc/}
        case $process in 1 | "$out" | "$err") ;; *) kill -KILL "$process" 2>/dev/null ;; esac
    done
    wait "$out" "$err"
    echo "$status" >"$XT28_JOB/status"
fi
sync
# reboot(2) with LINUX_REBOOT_CMD_POWER_OFF, from the one interpreter every Debian has.
exec perl -e 'syscall(169, 0xfee1dead, 0x28121969, 0x4321fedc)'
