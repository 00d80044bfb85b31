:- module(peer_main, [peer_main/0]).

/** <module> The other processes of the tests of hops

    swipl -g peer_main test/lib/peer_main.pl -- Options

carries out the goals that come on standard input, one after the other, and
answers each with a line: yes(Goal), `no` or raised(Error). Ends with its
input. Options:

    --codec=text             send text to all peers

*Threading*: the main thread carries out the goals.
*/

:- use_module(common).
:- use_module(slowness, [patience/2]).
:- use_module(library(typhon)).
:- use_module(library(lists), [member/2]).
:- use_module(library(option), [option/2, option/3]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(settings), [set_setting/2, setting/2]).
:- use_module(library(main), [argv_options/3]).
:- use_module(library(prolog_wrap), [wrap_predicate/4]).

peer_main :-
    current_prolog_flag(argv, Argv),
    argv_options(Argv, _, Options),
    set_up(Options),
    set_prolog_flag(toplevel_mode, backtracking),
    serve,
    halt.

set_up(Options) :-
    (   option(codec(text), Options)
    ->  set_setting(typhon_handshake:records, false)
    ;   true
    ).

serve :-
    read_term(user_input, Goal, []),
    (   Goal == end_of_file
    ->  true
    ;   answer(Goal, Answer),
        format('~k.~n', [Answer]),
        flush_output,
        serve
    ).

answer(Goal, Answer) :-
    catch(( peer_main:Goal -> Answer = yes(Goal) ; Answer = no ),
          Error,
          raised(Error, Answer)).

raised(error(Formal, _), raised(error(Formal, _))) :-
    !.
raised(Ball, raised(Ball)).

                /*******************************
                *        WHAT TESTS ASK        *
                *******************************/

%   The agents in this process, whatever other processes know.

agent_here(Id) :-
    typhon_agents:agent(Id, _, _, _, _).

status_here(Id) :-
    typhon_agents:agent_status(Id, _, _).

%   The agent is under way as a frame; reading its properties would change
%   that.

handed_over(Id) :-
    typhon_agents:agent_under_way(Id, _, _, _, _, _),
    !.

agents_here(Ids) :-
    findall(Id, agent_here(Id), Ids).

agent_named_here(Name) :-
    agent_named_here(Name, _),
    !.

agent_named_here(Name, State) :-
    atom_concat(Name, '.', Start),
    agent_here(Id),
    atom_concat(Start, _, Id),
    catch(agent_property(Id, state(State)), error(_, _), fail).

agent_state_here(Id, State) :-
    agent_here(Id),
    agent_property(Id, state(State)).

connected_to(Host) :-
    typhon_hosts:address_parts(Host, _, Endpoint),
    typhon_wire:endpoint_peer(Endpoint, state(up)).

%   A thread is connecting, or a connection is neither assigned to a session
%   nor refused yet.

connecting :-
    typhon_connection_manager:attempt(_, _, _, _),
    !.
connecting :-
    typhon_threads:wire_thread(Thread),
    member(Prefix, [typhon_in_, typhon_out_]),
    sub_atom(Thread, 0, _, _, Prefix),
    \+ typhon_session:serving(_, Thread, _),
    !.

outcome_here(Id, Outcome) :-
    typhon_whereabouts:agent_outcome(Id, Outcome).

%   Without an index on Id: SWI-Prolog 9.0.4 may list a clause twice in an
%   index that is made while clauses are added.

steps_here(Id, Steps) :-
    findall(K,
            ( typhon_hosts:host(_, _, Place),
              Place:'$tuple'(Tuple),
              Tuple = step(Id, K) ),
            Steps).

%   try_move(+Host, +Options, -Error): an agent of Options tries to move
%   to Host.

try_move(Host, Options, Error) :-
    Clauses = [ (:- agent(trier, [state([to/1])])),
                (main :- to(To),
                         catch(move(To), error(E, _), true),
                         leave(tried(E))) ],
    agent_create(clauses(Clauses), Id, [facts([to(Host)])|Options]),
    agent_join(Id, done, 20),
    once(( typhon_hosts:host(Name, _, _),
           remote(Name, take(tried(Error0))) )),
    Error = error(Error0).

%   Runs a goal in another thread; `background`: it has not ended.

:- dynamic background/0.

in_background(Goal) :-
    assertz(background),
    thread_create(call_cleanup(catch(peer_main:Goal, error(_, _), true),
                               retract(background)),
                  _, [detached(true)]).

send_in_background(Id, Count) :-
    thread_create(forall(between(1, Count, I), agent_send(Id, n(I))), _,
                  [detached(true)]).

%   Attempts to connect fail soon, but succeed also on a slow machine.

hurried :-
    patience(0.3, Seconds),
    set_setting(typhon_connection_manager:connect_time, Seconds).

%   A connection does not end because the machine is slow.

unhurried :-
    forall(member(Setting, [ typhon_connection_manager:connect_time,
                             typhon_handshake:handshake_time,
                             typhon_reader:silence ]),
           ( setting(Setting, Seconds0),
             patience(Seconds0, Seconds),
             set_setting(Setting, Seconds) )).

%   This process opens no connections: others do.

calls_nobody :-
    wrap_predicate(typhon_connection:connect(_, _, _), calls_nobody, _,
                   throw(error(socket_error(econnreset, reset), _))).

%   Messages for Id wait here after a failed attempt.

kept(Id) :-
    typhon_mail:backlog(Id).

tried_in_vain(Id) :-
    typhon_mail:waits(Id, _, Tries, _),
    Tries > 0.

news_kept(Count) :-
    aggregate_all(count, typhon_news:news(_, _, _), Count).

%   Count the messages that arrive.

:- dynamic message_seen/0.

count_messages :-
    wrap_predicate(typhon_mail:pass_on(_, _), count, Wrapped,
                   ( assertz(peer_main:message_seen), Wrapped )).

messages_seen(Count) :-
    aggregate_all(count, message_seen, Count).

%   Count the programs in the frames that arrive.

:- dynamic program_seen/0.

count_programs :-
    wrap_predicate(typhon_arrival:arrive(_, _, Program, _, _, _), count,
                   Wrapped,
                   ( ( Program == known
                     -> true
                     ;  assertz(peer_main:program_seen)
                     ),
                     Wrapped )).

programs_seen(Count) :-
    aggregate_all(count, program_seen, Count).

%   Arrivals are installed, but not answered.

silence_answers :-
    wrap_predicate(typhon_request:endpoint_reply_later(_, _), mute, _,
                   true),
    settle_nothing.

%   Frames are acknowledged as received, but not as settled.

settle_nothing :-
    wrap_predicate(typhon_frame:frame_write(_, Counts, _), unsettled, Wrapped,
                   ( setarg(2, Counts, 0), Wrapped )).

%   Answers to arrivals are held back until give_answers/0.

:- dynamic answer_kept/2.               % ReplyTo, Answer

keep_answers :-
    wrap_predicate(typhon_request:endpoint_reply_later(ReplyTo, Answer),
                   keep, _,
                   assertz(peer_main:answer_kept(ReplyTo, Answer))),
    settle_nothing.

give_answers :-
    forall(retract(answer_kept(ReplyTo, Answer)),
           typhon_request:endpoint_reply(ReplyTo, Answer)),
    unwrap_predicate(typhon_frame:frame_write/3, unsettled),
    forall(typhon_session:session(_, Session),
           typhon_session:session_acknowledge(Session)).

