/*
 * Lets User Mode Linux 6.1 run on processors whose register state outgrew it.
 *
 * A guest process is a traced host process. On every switch the guest kernel writes that
 * process's floating point and vector registers back with PTRACE_SETREGSET, from a buffer whose
 * size was fixed when AVX-512 was the largest thing a processor had (some 2.7 kB). Processors with
 * AMX tiles have an 11 kB state, the host refuses a write shorter than its own state, and the
 * guest panics at its first process.
 *
 * Preloaded in front of libc's ptrace, this shim lengthens such a short write to the host's size.
 * The added bytes are zero; in the XSAVE format a component whose header bit is clear is in its
 * initial state whatever its bytes say, so nothing the guest knows of is changed. What is lost is
 * tile state of a guest process that uses AMX, which no test of ours does.
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <elf.h>
#include <stdarg.h>
#include <string.h>
#include <sys/ptrace.h>
#include <sys/types.h>
#include <sys/uio.h>

typedef long (*ptrace_fn)(int request, pid_t pid, void *address, void *data);

static ptrace_fn libc_ptrace;
/* Static, for the guest kernel calls from stacks of a few pages; safe, for it has one processor. */
static unsigned char state[64 * 1024] __attribute__((aligned(64)));
static size_t host_size;

/* Before main, while malloc is still libc's: the guest kernel brings its own later. */
__attribute__((constructor)) static void find_libc_ptrace(void)
{
	libc_ptrace = (ptrace_fn)dlsym(RTLD_NEXT, "ptrace");
}

/* Asks the host once how long this process's state is; 0 where it does not say. */
static size_t host_state_size(pid_t pid)
{
	if (host_size == 0) {
		struct iovec whole = { .iov_base = state, .iov_len = sizeof state };
		if (libc_ptrace(PTRACE_GETREGSET, pid, (void *)NT_X86_XSTATE, &whole) == 0)
			host_size = whole.iov_len;
	}
	return host_size;
}

long ptrace(enum __ptrace_request request, ...)
{
	va_list arguments;
	va_start(arguments, request);
	pid_t pid = va_arg(arguments, pid_t);
	void *address = va_arg(arguments, void *);
	void *data = va_arg(arguments, void *);
	va_end(arguments);

	if (request == PTRACE_SETREGSET && address == (void *)NT_X86_XSTATE) {
		const struct iovec *given = data;
		size_t wanted = host_state_size(pid);
		if (given->iov_len < wanted && wanted <= sizeof state) {
			struct iovec padded = { .iov_base = state, .iov_len = wanted };
			memset(state, 0, wanted);
			memcpy(state, given->iov_base, given->iov_len);
			return libc_ptrace(request, pid, address, &padded);
		}
	}
	return libc_ptrace(request, pid, address, data);
}
