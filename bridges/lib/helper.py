"""What all helpers of Typhon have in common.

A helper is a process that Prolog starts and keeps (prolog/typhon/bridges/helper).
Requests come on its standard input; answers, and what it says unasked, go
to its standard output: one JSON object per line, UTF-8.

    {"id": 7, "do": "greet", "name": "Lizzy", "timeout": 3}
    {"id": 7, "ok": "hello Lizzy"}
    {"id": 8, "error": "bad_request", "message": "name: not a string"}
    {"event": "visitor", "name": "Rob"}

A request without an id is not answered; if it cannot be done there is an
event `untold`.

A helper is a subclass with a method for each `do`:

    from helper import Helper, Refusal, text

    class Greeter(Helper):
        def do_greet(self, request, deadline):
            name = text(request, 'name')
            if name == 'none':
                raise Refusal('unknown', 'no such name')
            self.event('visitor', name=name)
            return 'hello ' + name

    Greeter(threads=4).run()

A method may return LATER and say `self.reply(request, answer)` when there
is one, or `self.reply(request, Refusal(...))`, in any thread.  With
`return self.later(pool, request, function)` a thread of a pool answers.

A library that runs callbacks in a thread of its own often does so under its
own locks.  So a callback must not take a lock that is held around a call of
the library: each thread would wait for the other.  It passes on what it has
to say by `self.soon(function, ...)`, which the serving thread calls before
the next request.  State that only this thread touches needs no lock.

Requests are served by so many threads, with one thread in the order in
which they came.  `deadline` is when the request must be done, by
time.monotonic(); it counts from when the line was read.  A request that has
not been served at its deadline is answered `timeout` if the helper is
`watched`; its thread goes on, another takes its place, and what it returns
in the end is dropped.  What raises any other exception is answered with
error `exception`, `class` and `message`, and the process goes on.

When the standard input ends without `quit` the helper is not needed any
more: abandoned() is run, and the process ends.  Whatever is printed goes to
the standard error: the standard output is for Prolog alone.
"""

import collections
import functools
import heapq
import itertools
import json
import os
import queue
import signal
import sys
import threading
import time

LATER = object()                        # the answer will come
LONGEST_TIMEOUT = 3600.0                # seconds
FAREWELL = 2.0                          # seconds, to end what was under way
UNFIT = 3                               # exit status


class BadRequest(Exception):
    """A line that is no request."""


class Refusal(Exception):
    """The answer is an error of that kind; `more` are fields of it."""

    def __init__(self, kind, message, **more):
        super().__init__(message)
        self.kind, self.more = kind, more


# The fields of requests

def integer(request, field, least, most):
    value = request.get(field)
    if isinstance(value, bool) or not isinstance(value, int) \
            or not least <= value <= most:
        raise BadRequest('%s: not an integer from %d to %d'
                         % (field, least, most))
    return value


def text(request, field):
    value = request.get(field)
    if not isinstance(value, str):
        raise BadRequest('%s: not a string' % field)
    return value


def parse(line):
    try:
        request = json.loads(line.decode())
    except (ValueError, RecursionError) as problem:
        raise BadRequest('not JSON: %s' % problem) from None
    if not isinstance(request, dict):
        raise BadRequest('not an object')
    return request


def deadline_of(request):
    timeout = request.get('timeout', LONGEST_TIMEOUT)
    if isinstance(timeout, bool) or not isinstance(timeout, (int, float)) \
            or not 0 < timeout <= LONGEST_TIMEOUT:
        raise BadRequest('timeout: not a number of seconds up to %d'
                         % LONGEST_TIMEOUT)
    return time.monotonic() + timeout


class Output:
    """Lines to Prolog, from any thread."""

    def __init__(self, stream):
        self.stream, self.lock = stream, threading.Lock()

    def say(self, message):
        line = json.dumps(message, default=bytes.hex,
                          allow_nan=False) + '\n'
        with self.lock:
            try:
                self.stream.write(line.encode())
                self.stream.flush()
            except OSError:
                pass        # its reader is gone; standard input ends, too


class Requests(queue.Queue):
    """Jobs, and before these the calls that put_first() was given.

    Only jobs have a bound: put_first() never waits.
    """

    def _init(self, maxsize):
        super()._init(maxsize)
        self.first = collections.deque()

    def _qsize(self):
        return len(self.first) + super()._qsize()

    def _get(self):
        return self.first.popleft() if self.first else super()._get()

    def put_first(self, call):
        with self.mutex:
            self.first.append(call)
            self.unfinished_tasks += 1
            self.not_empty.notify()


class Job:
    """A request that is to be answered once."""

    def __init__(self, number, request, deadline):
        self.number, self.request = number, request
        self.deadline = deadline
        self.lock = threading.Lock()
        self.answered, self.begun, self.ended = False, False, False
        self.replaced = False           # another thread serves instead

    def first(self):
        """Whether it has not been answered before."""
        with self.lock:
            first, self.answered = not self.answered, True
            return first

    def begin(self):
        """Whether it is still to be done."""
        with self.lock:
            self.begun = not self.answered
            return self.begun

    def end(self):
        """Its method has returned; whether its thread is still needed."""
        with self.lock:
            self.ended = True
            return not self.replaced

    def replace(self):
        """Whether its thread is busy with it, and needs a replacement."""
        with self.lock:
            self.replaced = self.begun and not self.ended
            return self.replaced


class Watch:
    """Answers requests that are late, and replaces their threads."""

    def __init__(self, late):
        self.late = late
        self.heap, self.count = [], itertools.count()
        self.wake = threading.Condition()
        threading.Thread(target=self.run, daemon=True).start()

    def add(self, job):
        with self.wake:
            heapq.heappush(self.heap, (job.deadline, next(self.count), job))
            if self.heap[0][2] is job:
                self.wake.notify()

    def run(self):
        while True:
            with self.wake:
                while self.heap and self.heap[0][2].answered:
                    heapq.heappop(self.heap)
                if not self.heap:
                    self.wake.wait()
                    continue
                left = self.heap[0][0] - time.monotonic()
                if left > 0:
                    self.wake.wait(left)
                    continue
                job = heapq.heappop(self.heap)[2]
            if job.first():
                self.late(job)


class Helper:
    """Serves requests; see above."""

    def __init__(self, threads=1, watched=True, longest_line=1 << 24,
                 longest_queue=1000, most_late=100):
        self.threads, self.watched = threads, watched
        self.longest_line, self.longest_queue = longest_line, longest_queue
        self.most_late = most_late
        self.requests = Requests(longest_queue)
        self.quitting = False
        self.output = self.watch = None
        self.late_lock, self.late_threads = threading.Lock(), 0

    # What a helper may do in its own way

    needed = ()                             # what later requests may need

    def coming(self, request):
        """One of these will be done, and was asked before what follows."""

    def do(self, request, deadline):
        """The answer to a request."""
        what = request.get('do')
        method = getattr(self, 'do_' + what, None) \
            if isinstance(what, str) else None
        if method is None:
            raise BadRequest('do: %r is not known' % (what,))
        return method(request, deadline)

    def do_quit(self, _request, _deadline):
        """The last request."""
        return {}

    def drop(self):
        """No caller waits any more for what is under way."""

    def abandoned(self):
        """Prolog is gone."""

    def event(self, kind, /, **fields):
        """Say something unasked."""
        fields['event'] = kind
        self.output.say(fields)

    def soon(self, function, /, *arguments):
        """Have the serving thread call it; see above.

        May be called in any thread, and never waits.  Only for helpers with
        one serving thread.
        """
        self.requests.put_first(functools.partial(function, *arguments))

    # In a thread of its own: standard input

    def listen(self, stream):
        while True:
            line = stream.readline(self.longest_line + 1)
            if not line.endswith(b'\n'):
                if len(line) <= self.longest_line:
                    break               # the end
                self.refuse(None, 'a line of more than %d bytes'
                            % self.longest_line)
                while line and not line.endswith(b'\n'):
                    line = stream.readline(self.longest_line)
            elif line.strip():
                self.accept(line)
        self.ended()

    def accept(self, line):
        number = None
        try:
            request = parse(line)
            if 'id' in request:
                number = integer(request, 'id', 0, 2 ** 62)
            deadline = deadline_of(request)
            if request.get('do') == 'quit':
                self.quitting = True
                self.drop_requests()
            job = Job(number, request, deadline)
            needed = request.get('do') in self.needed
            if needed:
                self.coming(request)
            if number is None or needed:
                self.requests.put(job)      # requests without answer may wait here
                if self.watch and number is not None:
                    self.watch.add(job)
            else:
                self.requests.put_nowait(job)
                if self.watch:
                    self.watch.add(job)
        except BadRequest as problem:
            self.refuse(number, str(problem))
        except queue.Full:
            self.refuse(number, 'more than %d requests wait'
                        % self.longest_queue)

    def refuse(self, number, why):
        self.output.say({'id': number, 'error': 'bad_request',
                         'message': why})

    def drop_requests(self):
        """What is still to be done is not wanted any more."""
        self.drop()
        try:
            while True:
                self.requests.get_nowait()
        except queue.Empty:
            pass

    def ended(self):
        if not self.quitting:               # Prolog is gone
            self.drop_requests()
            self.requests.put(None)
        time.sleep(2 * FAREWELL)            # something may block for ever
        os._exit(1)

    # In the threads that serve

    def serve(self):
        while True:
            job = self.requests.get()
            if job is None:
                self.abandoned()
                os._exit(0)
            if not isinstance(job, Job):
                job()                       # of soon()
                continue
            last = job.request.get('do') == 'quit'
            if job.begin():
                answer = self.answer(job)
                if not job.end():
                    with self.late_lock:
                        self.late_threads -= 1
                    return
                if answer is not LATER and job.first():
                    self.say(job, answer)
            if last:
                sys.stderr.flush()
                os._exit(0)                 # other threads may be reading

    def say(self, job, answer):
        job.request = None                  # it may be long
        if job.number is None:
            if 'error' in answer:
                self.event('untold', message=answer['message'])
            return
        try:
            self.output.say(dict(answer, id=job.number))
        except (TypeError, ValueError, RecursionError) as problem:
            self.output.say({'id': job.number, 'error': 'no_json',
                             'message': str(problem)})

    def answer(self, job):
        job.request['job'] = job
        return self.outcome(job, self.do, job.request, job.deadline)

    def outcome(self, job, function, /, *arguments):
        """What function returns or raises, as an answer."""
        try:
            if time.monotonic() >= job.deadline:
                raise Refusal('timeout', 'not done: others took too long')
            done = function(*arguments)
            return done if done is LATER else {'ok': done}
        except Refusal as problem:
            return self.refused(problem)
        except BadRequest as problem:
            return {'error': 'bad_request', 'message': str(problem)}
        except BaseException as problem:    # also that of sys.exit()
            return {'error': 'exception', 'class': type(problem).__name__,
                    'message': str(problem)}

    @staticmethod
    def refused(problem):
        return dict(problem.more, error=problem.kind, message=str(problem))

    def reply(self, request, answer):
        """Answer a request whose method has returned LATER."""
        job = request['job']
        if job.first():
            self.say(job, self.refused(answer)
                     if isinstance(answer, Refusal) else {'ok': answer})

    def later(self, pool, request, function, /, *arguments):
        """Have a thread of pool answer a request, with what function does."""
        job = request['job']

        def work():
            answer = self.outcome(job, function, *arguments)
            if job.first():
                self.say(job, answer)

        pool.submit(work)
        return LATER

    def late(self, job):
        """The deadline has passed; its method may never return."""
        self.output.say({'id': job.number, 'error': 'timeout',
                         'message': 'not done in time'})
        if job.replace():
            with self.late_lock:
                self.late_threads += 1
                many = self.late_threads > self.most_late
            if many:
                self.complain('stuck', 'too many calls do not end')
                os._exit(4)
            self.start_serving()

    def complain(self, kind, message, **more):
        """An error that belongs to no request, before the end.

        With again=False it is not started again until it is asked.
        """
        self.output.say(dict(more, id=None, error=kind, message=message))

    def start_serving(self):
        threading.Thread(target=self.serve, daemon=True).start()

    def connect(self):
        """The standard output is for Prolog alone from now on."""
        sys.stdout.flush()
        stream = os.fdopen(os.dup(1), 'wb')
        os.dup2(2, 1)
        self.output = Output(stream)

    def run(self):
        """Serve until the end; it does not return."""
        if self.output is None:
            self.connect()
        # The interrupt key of a terminal is for Prolog.
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        if self.watched:
            self.watch = Watch(self.late)
        threading.Thread(target=self.listen, args=(sys.stdin.buffer,),
                         daemon=True).start()
        for _ in range(self.threads - 1):
            self.start_serving()
        self.serve()
        threading.Event().wait()            # it was replaced; others serve


class Unfit(Helper):
    """Says that this Python lacks a module, and ends."""

    def __init__(self, kind, problem):
        super().__init__()
        self.complaint = kind, str(problem)

    def run(self):
        self.connect()
        self.complain(*self.complaint, python=sys.executable, again=False)
        sys.exit(UNFIT)
