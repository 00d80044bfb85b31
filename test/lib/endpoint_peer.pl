:- module(endpoint_peer,
          [ serve/1,                    % +Port
            sleep_until/1               % +Time
          ]).

/** <module> The other process of the endpoint tests

    swipl -g "serve(Port)" test/lib/endpoint_peer.pl

listens to Port, prints its address, and reads commands: `restart` starts the
endpoint anew and prints its new address; greet(Address, Time) posts to
Address at Time, a time stamp, and prints outcome(Outcome, Seconds); any other
command ends it.

Posts of kind `note` are remembered; at `back` N are posted to the sender.
Requests are

  - `echo`, `process` (its id), `notes` (all notes so far), `count` (how many)
  - `later` (answered by another thread), `never`, `wrong` (the hook raises)
  - `remember`: the term is a note
  - `back`: posts N notes to the asker and then answers
  - greet(Address, N): the same to another, in a thread of its own
  - cross(Address, Size, N): posts a string of Size to Address N times, and
    asks it for one, in a thread of its own
  - ask(Address, Size), of kind `ask_back`: asks Address for a string, in a
    thread of its own
  - reach(Addresses): posts to all of them at once; the answer lists those
    that could not be reached
  - string(Size): the answer is one
*/

:- use_module(common).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(typhon/kernel/wire)).

:- dynamic note/1.

:- multifile
    typhon_endpoint:received/3,
    typhon_endpoint:requested/4,
    typhon_kinds:accepts/5.

typhon_kinds:accepts(post, Kind, _, none, none) :-
    memberchk(Kind, [note, back]).
typhon_kinds:accepts(request, Kind, _, none, none) :-
    memberchk(Kind, [ ask_back, back, count, cross, echo, greet, later, never,
                      notes, process, reach, remember, string, wrong ]).

typhon_endpoint:received(note, Note, _) :-
    assertz(note(Note)).

typhon_endpoint:received(back, N, Peer) :-
    forall(between(1, N, I), endpoint_post(Peer, note, I)).

typhon_endpoint:requested(echo, Term, _, ReplyTo) :-
    endpoint_reply(ReplyTo, Term).
typhon_endpoint:requested(process, _, _, ReplyTo) :-
    endpoint_process(Id),
    endpoint_reply(ReplyTo, Id).
typhon_endpoint:requested(notes, _, _, ReplyTo) :-
    findall(Note, note(Note), Notes),
    endpoint_reply(ReplyTo, Notes).
typhon_endpoint:requested(later, Term, _, ReplyTo) :-
    thread_create(endpoint_reply(ReplyTo, Term), _, [detached(true)]).
typhon_endpoint:requested(never, _, _, _).
typhon_endpoint:requested(wrong, _, _, _) :-
    throw(error(type_error(right, wrong), _)).
typhon_endpoint:requested(back, N, Peer, ReplyTo) :-
    forall(between(1, N, I), endpoint_post(Peer, note, I)),
    endpoint_reply(ReplyTo, done).
typhon_endpoint:requested(greet, Address-N, _, ReplyTo) :-
    in_thread(( forall(between(1, N, I), endpoint_post(Address, note, I)),
                endpoint_reply(ReplyTo, done) )).
typhon_endpoint:requested(count, _, _, ReplyTo) :-
    aggregate_all(count, note(_), Count),
    endpoint_reply(ReplyTo, Count).
typhon_endpoint:requested(remember, Note, _, ReplyTo) :-
    assertz(note(Note)),
    endpoint_reply(ReplyTo, Note).
typhon_endpoint:requested(cross, cross(Address, Size, N), _, ReplyTo) :-
    in_thread(( cross(Address, Size, N),
                endpoint_reply(ReplyTo, done) )).
typhon_endpoint:requested(ask_back, ask(Address, Size), _, ReplyTo) :-
    in_thread(( endpoint_call(Address, string, Size, answer(_), 60),
                endpoint_reply(ReplyTo, done) )).
typhon_endpoint:requested(reach, Addresses, _, ReplyTo) :-
    in_thread(( reach(Addresses, Missed),
                endpoint_reply(ReplyTo, Missed) )).
typhon_endpoint:requested(string, Size, _, ReplyTo) :-
    big_string(Size, String),
    endpoint_reply(ReplyTo, String).

:- meta_predicate in_thread(0).

in_thread(Goal) :-
    thread_create(Goal, _, [detached(true)]).

cross(Address, Size, N) :-
    big_string(Size, String),
    forall(between(1, N, _),
           ( endpoint_post(Address, note, String),
             endpoint_call(Address, string, Size, answer(Back), 120),
             string_length(Back, Size) )).

%   Made of two halves: no longer string is made in between.

big_string(0, "") :-
    !.
big_string(Size, String) :-
    Half is Size//2,
    big_string(Half, Begin),
    string_concat(Begin, Begin, Twice),
    rest(Size, Twice, String).

rest(Size, Twice, Twice) :-
    Size mod 2 =:= 0,
    !.
rest(_, Twice, String) :-
    string_concat(Twice, "x", String).

reach(Addresses, Missed) :-
    length(Addresses, Count),
    message_queue_create(Queue),
    forall(member(Address, Addresses),
           in_thread(( greeted(Address, Outcome),
                       thread_send_message(Queue, Address-Outcome) ))),
    findall(Address-Outcome,
            ( between(1, Count, _),
              thread_get_message(Queue, Address-Outcome),
              Outcome \== ok ),
            Missed),
    message_queue_destroy(Queue).

greeted(Address, Outcome) :-
    catch(( endpoint_post(Address, note, hello), Outcome = ok ),
          error(Outcome, _),
          true).

serve(Port) :-
    set_prolog_flag(verbose, silent),
    start(Port),
    repeat,
    read_term(user_input, Command, []),
    (   command(Command)
    ->  fail
    ;   !,
        endpoint_stop,
        halt
    ).

start(Port) :-
    endpoint_start(localhost, Port, [], Address),
    format("~w~n", [Address]),
    flush_output.

command(restart) :-
    endpoint_stop,
    retractall(note(_)),
    start(0).
command(greet(Address, Time)) :-
    sleep_until(Time),
    get_time(T0),
    greeted(Address, Outcome),
    get_time(T1),
    Seconds is T1-T0,
    format("~q.~n", [outcome(Outcome, Seconds)]),
    flush_output.

%!  sleep_until(+Time) is det.

sleep_until(Time) :-
    get_time(Now),
    Seconds is max(0, Time-Now),
    sleep(Seconds).
