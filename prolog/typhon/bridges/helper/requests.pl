:- module(typhon_helper_requests,
          [ helper_open/3,              % +Name, +Command, +Options
            helper_close/1,             % +Name
            helper_ask/4,               % +Name, +Request, +Seconds, -Answer
            helper_call/5,              % +Name, +Request, +Seconds, :Error,
                                        % -Reply
            helper_send/2,              % +Name, +Request
            helper_note/2,              % +Name, +Request
            helper_pid/2                % ?Name, ?Pid
          ]).
:- use_module(library(error), [existence_error/2, permission_error/3]).
:- use_module(library(option), [option/3]).
:- use_module('../../kernel/base/fifo', [fifo_send/2]).
:- use_module('../json', [json_text/2]).
:- use_module('../../kernel/base/own_thread', [in_own_thread/1]).
:- use_module('../../kernel/base/server',
              [server_call/4, server_cast/2, server_start/4, server_stop/1]).
:- use_module(owner,
              [answer_unwanted/1, own/4, own_state/2, request_line/4]).
:- use_module(process, [process_kill_of/1, process_pid/2]).

/** <module> Requests to helpers, and their answers

Every helper has a server that owns its process, see typhon_helper_owner.
Answers, in any order, are passed to the waiting callers.

A helper stops working on a request at its deadline.  The caller waits two
seconds longer, then kills a helper that has not answered, so no call blocks
for ever.

*Threading*: any thread may send requests.  A late answer is dropped.
*/

:- meta_predicate helper_call(+, +, +, 2, -).

:- dynamic
    helper/4.                   % Text, Owner, Queue of lines, Name:
                                % indexed by Text, see find_helper/3

grace_seconds(2).
stop_seconds(5).
most_lines(1000).               % lines that wait to be written

%!  helper_open(+Name, +Command, +Options) is det.
%
%   Begin a helper Name.  Command is command(Program, Args), for
%   process_create/3. Options:
%
%     - restart(When): `asked` (default): a request starts the process, also
%       after it has ended; or `always`: the process starts at once, and again
%       when it ends
%
%   @error permission_error(open, helper, Name) if the helper Name exists

helper_open(Name, Command, Options) :-
    option(restart(When), Options, asked),
    with_mutex(typhon_helper, open_helper(Name, Command, When)).

open_helper(Name, _, _) :-
    text(Name, Text),
    helper(Text, _, _, _),
    !,
    permission_error(open, helper, Name).
open_helper(Name, Command, When) :-
    Name =.. Parts,
    atomic_list_concat(Parts, '_', Role),
    text(Name, Text),
    most_lines(Max),
    own_state(When, State),
    sig_atomic(( message_queue_create(Lines, [max_size(Max)]),
                 server_start(Role,
                              own(owner(Name, Command, When, Role, Lines)),
                              State, Owner),
                 assertz(helper(Text, Owner, Lines, Name)) )).

%!  helper_close(+Name) is det.
%
%   End the helper, if there is one; it gets the request `quit` before.  Open
%   requests get the answer `closed`.

helper_close(Name) :-
    text(Name, Text),
    (   retract(helper(Text, Owner, Lines, _))
    ->  in_own_thread(close_helper(Owner, Lines))
    ;   true
    ).

close_helper(Owner, Lines) :-
    stop_seconds(Seconds),
    (   server_call(Owner, quit, Seconds, done)
    ->  true
    ;   process_kill_of(Owner)
    ),
    server_stop(Owner),
    message_queue_destroy(Lines).

%!  helper_pid(?Name, ?Pid) is nondet.
%
%   The helper Name has the process Pid now.

helper_pid(Name, Pid) :-
    helper(_, Owner, _, Name0),
    Name = Name0,
    process_pid(Owner, Pid).

%!  helper_ask(+Name, +Request, +Seconds, -Answer) is det.
%
%   Send Request, a dict, to the helper, which gets it with an `id` and a
%   `timeout`. Answer is
%
%     - ok(Reply)
%     - said(Dict): an error of the helper, with its kind as a string, `error`,
%       and its `message`; kinds include `bad_request` and `timeout`
%     - died(Status): the process ended, Status as of process_wait/2
%     - stuck: the process had to be killed
%     - closed: the helper was closed meanwhile
%     - error(Formal, Context): the process could not be started
%
%   @error existence_error(helper, Name)

helper_ask(Name, Request, Seconds, Answer) :-
    find_helper(Name, Owner, _),
    request_line(Request, Seconds, Id, Line),
    grace_seconds(Grace),
    Longest is Seconds+Grace,
    call_cleanup(ask(Name, Owner, request(Id, Line), Longest, Answer),
                 answer_unwanted(Id)).

ask(Name, Owner, Request, Seconds, Answer) :-
    (   catch(server_call(Owner, Request, Seconds, Answer0),
              error(existence_error(server, _), _),
              existence_error(helper, Name))
    ->  Answer = Answer0
    ;   process_kill_of(Owner),
        Answer = stuck
    ).

%!  helper_send(+Name, +Request) is det.
%!  helper_note(+Name, +Request) is det.
%
%   As helper_ask/4, but without an answer.  The request is dropped if no
%   process is running.  helper_send/2 waits while many requests are to be
%   written, so that a fast caller cannot fill the memory; helper_note/2 never
%   waits.
%
%   @error existence_error(helper, Name)

helper_send(Name, Request) :-
    find_helper(Name, Owner, Lines),
    json_text(Request, Line),
    ( fifo_send(Lines, Line) -> true ; existence_error(helper, Name) ),
    pass(Name, Owner, line).

helper_note(Name, Request) :-
    find_helper(Name, Owner, _),
    json_text(Request, Line),
    pass(Name, Owner, note(Line)).

pass(Name, Owner, Message) :-
    (   server_cast(Owner, Message)
    ->  true
    ;   existence_error(helper, Name)
    ).

%   The table is indexed by text: an index on compound terms is unsafe if other
%   threads retract facts.

find_helper(Name, Owner, Lines) :-
    text(Name, Text),
    (   helper(Text, Owner0, Lines0, _)
    ->  Owner = Owner0,
        Lines = Lines0
    ;   existence_error(helper, Name)
    ).

text(Name, Text) :-
    format(atom(Text), '~q', [Name]).

                /*******************************
                *             ERRORS           *
                *******************************/

:- multifile prolog:error_message//1.

%!  helper_call(+Name, +Request, +Seconds, :Error, -Reply) is det.
%
%   As helper_ask/4, but answers other than ok(Reply) raise an error: that of
%   call(Error, Answer, Ball), or, if this fails, a general one.
%
%   @error timeout_error(What, Name), What being the `do` of Request
%   @error helper_died(Status, Name), existence_error(helper, Name),
%   helper_error(Kind, Name)

helper_call(Name, Request, Seconds, Error, Reply) :-
    helper_ask(Name, Request, Seconds, Answer),
    (   Answer = ok(Reply0)
    ->  Reply = Reply0
    ;   call(Error, Answer, Ball)
    ->  throw(Ball)
    ;   failure(Answer, Name, Request, Formal, Text),
        throw(error(Formal, context(_, Text)))
    ).

failure(said(Dict), Name, Request, Formal, Text) :-
    get_dict(error, Dict, Kind),
    get_dict(message, Dict, Text),
    (   Kind == "timeout"
    ->  get_dict(do, Request, What),
        Formal = timeout_error(What, Name)
    ;   atom_string(Atom, Kind),
        Formal = helper_error(Atom, Name)
    ).
failure(died(Status), Name, _, helper_died(Status, Name), _).
failure(stuck, Name, _, helper_died(stuck, Name), _).
failure(closed, Name, _, existence_error(helper, Name), _).
failure(error(Formal, context(_, Text)), _, _, Formal, Text).

prolog:error_message(timeout_error(Request, Name)) -->
    { helper(_, _, _, Name) },
    [ 'The helper ~p did not answer ~p in time'-[Name, Request] ].
