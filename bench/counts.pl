:- use_module(common).
:- use_module(library(process), [process_create/3, process_wait/2]).
:- use_module(library(readutil), [read_line_to_string/2]).
:- use_module(library(typhon/kernel/wire)).

/*  What two counts in the head of a frame save.  A peer posts 64 MB at once, and
this process, which takes some time to handle each frame, posts to the peer
meanwhile.  The frames of the peer wait for the network, so what they settle is
behind what the peer has received.  With one count this process would keep its
frames until they are settled, and after a break send those again that are
received and not settled. */

:- initialization(main, main).

:- multifile
    typhon_endpoint:received/3,
    typhon_endpoint:requested/4,
    typhon_kinds:accepts/5.

typhon_kinds:accepts(post, note, _, none, none).
typhon_kinds:accepts(request, flood, _, none, none).

typhon_endpoint:received(note, _, _) :-
    flag(notes, Count, Count+1),
    get_flag(work, Work),
    forall(between(1, Work, _), true).

typhon_endpoint:requested(flood, Count, Peer, ReplyTo) :-
    thread_create(flood(Count, Peer, ReplyTo), _, [detached(true)]).

flood(Count, Peer, ReplyTo) :-
    note(16000, Note),
    forall(between(1, Count, _), endpoint_post(Peer, note, Note)),
    endpoint_reply(ReplyTo, done).

note(Length, Note) :-
    format(string(Note), "~`xt~*|", [Length]).

main([peer]) :-
    !,
    endpoint_start(localhost, 0, [], Address),
    format('~w~n', [Address]),
    flush_output,
    read_line_to_string(user_input, _),
    endpoint_stop.
main([_]) :-
    endpoint_start(localhost, 0, [], _),
    wrap_predicate(typhon_session:session_settled(_, Counts, _, _), seen, Body,
                   ( user:see(Counts), Body )),
    with_flooder(flooded),
    endpoint_stop.

see(counts(Received, Settled)) :-
    set_flag(received, Received),
    set_flag(settled, Settled).

:- meta_predicate with_flooder(1).

with_flooder(Goal) :-
    source_file(main(_), File),
    current_prolog_flag(executable, Swipl),
    setup_call_cleanup(
        process_create(Swipl, [File, '--', peer],
                       [stdin(pipe(In)), stdout(pipe(Out)), process(Pid)]),
        ( read_line_to_string(Out, Line),
          atom_string(Address, Line),
          call(Goal, Address) ),
        ( close(In), process_wait(Pid, _), close(Out) )).

flooded(Address) :-
    forall(member(Work, [1000, 10000]), flooded(Work, Address)).

%   flooded(+Work, +Address): this process needs Work inferences for a frame.

flooded(Work, Address) :-
    set_flag(work, Work),
    set_flag(notes, 0),
    note(600, Note),
    endpoint_request(Address, flood, 4000, user:sent),
    post_meanwhile(Address, Note, 4000, most(0, 0, 0), Most),
    Most = most(Two, One, Twice),
    format(atom(Name), 'frames kept, ~D inferences each', [Work]),
    ratio(Name, One, Two, frames, 'one count, two counts'),
    figure('of these sent twice after a break, one count', Twice, frames).

sent(_).

%   post_meanwhile(+Address, +Note, +Count, +Most0, -Most): post Note now and
%   then until Count notes have come.

post_meanwhile(_, _, Count, Most, Most) :-
    get_flag(notes, Count),
    !.
post_meanwhile(Address, Note, Count, Most0, Most) :-
    endpoint_post(Address, note, Note),
    sleep(0.0005),
    sample(Most0, Most1),
    post_meanwhile(Address, Note, Count, Most1, Most).

sample(most(Two0, One0, Twice0), most(Two, One, Twice)) :-
    once(typhon_session:session(_, Session)),
    typhon_session:session_pending(Session, Kept),
    get_flag(received, Received),
    get_flag(settled, Settled),
    Behind is max(0, Received-Settled),
    Two is max(Two0, Kept),
    One is max(One0, Kept+Behind),
    Twice is max(Twice0, Behind).
