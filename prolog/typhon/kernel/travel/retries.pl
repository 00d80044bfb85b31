:- module(typhon_retries,
          [ retry_later/3,              % +Id, +Letter, +Way
            retries_go_on/0
          ]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(settings), [setting/2]).
:- use_module('../base/durable_changes',
              [enqueue_changes/0, unit_of_work/1]).
:- use_module('../wire', [endpoint_gone/1, endpoint_peer/2]).
:- use_module('../host', [alarm_in/3, scheduler_call/1]).
:- use_module('../agent', [with_agent/2]).
:- use_module(backlog,
              [ backlog/1, backlog_add/2, backlog_again/3, backlog_begin/3,
                backlog_done/1, backlog_leaves/1 ]).
:- use_module(home, [agent_outcome/2]).
:- use_module(dead_letters, [mail_lost/3]).
:- use_module(routing, [one_letter/2, way_in/2, way_out/3, way_send/3]).

/** <module> Letters that are tried again

A letter that cannot be passed on waits, see typhon_backlog, and is tried
again: for as long as the next process may be alive, and for a while longer,
since the news that the agent had left it may be under way.

*Threading*: tried by workers, one at a time for each agent.
*/

:- multifile
    typhon_durable:go_on/0,
    typhon_scheduler:fire/2,
    typhon_scheduler:over/2.

%   The pause before a backlog is tried again, for the next time.  The
%   process is taken for gone after some tries.

pause(Tries, Seconds) :-
    Seconds is min(2.0, 0.05*2**min(Tries, 10)).

most_tries(6).

%   The end of a process that was never met is not reported: it is waited
%   for as long as for a home that has news to hear.

unknown_tries(Tries) :-
    most_tries(Least),
    pause(Least, Pause),
    setting(typhon_news:news_seconds, Seconds),
    Tries is max(Least, ceiling(Seconds/Pause)).

%!  retry_later(+Id, +Letter, +Way) is det.
%
%   Letter waits, Way being why, see way_out/3; inside with_agent/2.

retry_later(Id, _, wait(Letter)) :-
    !,
    backlog_add(Id, Letter),
    try_later(Id, 0).
retry_later(Id, _, to(_, Letter)) :-
    !,
    backlog_add(Id, Letter),
    scheduler_call(try(Id)).
retry_later(Id, letter(Mail, _), nowhere) :-
    agent_outcome(Id, _),
    !,
    mail_lost(existence_error(agent, Id), Id, Mail).
retry_later(Id, Letter, nowhere) :-
    backlog_add(Id, Letter),
    try_later(Id, 0).

try_later(Id, Tries) :-
    pause(Tries, Seconds),
    debug(typhon(mail), '~w: a letter waits ~3f seconds', [Id, Seconds]),
    alarm_in(Seconds, Id, mail).

typhon_scheduler:fire(Id, mail) :-
    !,
    scheduler_call(try(Id)).

typhon_scheduler:over(Id, mail) :-
    \+ backlog(Id).

typhon_durable:go_on :-
    retries_go_on.

%!  retries_go_on is det.
%
%   Letters that wait are tried before long.

retries_go_on :-
    forall(backlog(Id), try_later(Id, 0)).

%   try(+Id): in a worker.

try(Id) :-
    (   with_agent(Id, backlog_begin(Id, Letters, Tries))
    ->  one_letter(Letters, Letter),
        unit_of_work(tried(Id, Letter, Tries))
    ;   true
    ).

%   That it has left, and where it is now, is one entry, made before others can
%   add to what waits: what they note must not come before it.

tried(Id, Letter, Tries) :-
    with_agent(Id, ( catch(left(Id, Letter, Way), error(Formal, _),
                           Way = failed(Formal)),
                     (   Way = to(_, _)
                     ->  true
                     ;   conclude(Way, Id, Letter, Tries),
                         enqueue_changes
                     ) )),
    sent_on(Way, Id, Letter, Tries).

left(Id, Letter, Way) :-
    backlog_leaves(Id),
    step(Id, Letter, Way).

%   Where a connection has to be made first nothing is noted.

sent_on(to(Endpoint, Letter1), Id, Letter, Tries) :-
    !,
    catch(( way_send(Endpoint, Id, Letter1), Way = done ), error(Formal, _),
          Way = failed(Formal)),
    with_agent(Id, conclude(Way, Id, Letter, Tries)).
sent_on(_, _, _, _).

step(Id, letter(Mail, _), done) :-
    way_in(Id, Mail),
    !.
step(Id, Letter, Way) :-
    way_out(Id, Letter, Way).

conclude(done, Id, _, _) :-
    (   backlog_done(Id)
    ->  true
    ;   scheduler_call(try(Id))
    ).
conclude(wait(Letter), Id, _, _) :-
    backlog_again(Id, [Letter], 0),
    try_later(Id, 0).
conclude(nowhere, Id, Letter, Tries) :-
    in_vain(Id, Letter, Tries, existence_error(agent, Id)).
conclude(failed(Formal), Id, Letter, Tries) :-
    in_vain(Id, Letter, Tries, Formal).

in_vain(Id, letter(Mail, _), Tries, Formal) :-
    hopeless(Formal, Id, Tries),
    !,
    mail_lost(Formal, Id, Mail),
    conclude(done, Id, _, 0).
in_vain(Id, Letter, Tries, _) :-
    Tries1 is Tries+1,
    backlog_again(Id, [Letter], Tries1),
    try_later(Id, Tries1).

hopeless(existence_error(agent, Id), Id, Tries) :-
    (   agent_outcome(Id, _)
    ->  true
    ;   most_tries(Most),
        Tries >= Most
    ).
hopeless(host_unreachable(Endpoint), _, Tries) :-
    endpoint_gone(Endpoint),
    most_tries(Most),
    Tries >= Most.
hopeless(host_unreachable(Endpoint), _, Tries) :-
    \+ endpoint_peer(Endpoint, process(_)),
    unknown_tries(Most),
    Tries >= Most.
hopeless(resource_error(_), _, _).
hopeless(existence_error(endpoint, _), _, _).   % this process ends
