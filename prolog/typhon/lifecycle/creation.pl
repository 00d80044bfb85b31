:- module(typhon_creation,
          [ agent_start/4,              % +Id, +Host, +Spec, -Answer
            agent_clone_here/5,         % +Id, +CloneId, +Host, +Goals, -Answer
            agent_end/2,                % +Id, +Outcome
            agent_end/3                 % +Id, :Test, +Outcome
          ]).
:- use_module(library(lists), [member/2, nth1/3]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../wire', [mobile_term/1]).
:- use_module('../host', [host/3, host_enter/3, host_leave/1, host_log/3]).
:- use_module('../agent',
              [ agent/5, agent_enter/5, agent_mail/2, agent_module/5,
                agent_put/3, agent_ready/2, agent_remove/1, agent_state/2,
                agent_status/3, with_agent/2 ]).
:- use_module('../travel', [agent_born/2, agent_ended/3, hop_given_up/2]).

/** <module> How agents begin and end

*Threading*: any thread.  Who removes the record of an agent, inside
with_agent/2, is the one who reports its end.
*/

:- meta_predicate agent_end(+, 1, +).

:- dynamic faulty/1.                    % Id, the oldest first

:- setting(faulty, nonneg, 100, "Faulty agents kept for inspection").

%!  agent_start(+Id, +Host, +Spec, -Answer) is det.
%
%   Let an agent begin on Host, a host of this process.
%
%   @arg Spec is start(Hash, Life, State, Goals, Mail)
%   @arg Answer is `ok` or refused(Reason)

agent_start(Id, Host, start(Hash, Life, State, Goals, Mail), Answer) :-
    arg(4, Life, Tokens),
    host_enter(Host, Tokens, Answer),
    (   Answer == ok
    ->  host(Host, Address, Place),
        catch(with_agent(Id, born(Id, Host, Place, Hash, Life, State, Mail)),
              Ball,
              ( host_leave(Host), throw(Ball) )),
        agent_born(Id, Address),
        host_log(Host, Id, created),
        with_agent(Id, agent_ready(Id, Goals))
    ;   true
    ).

born(Id, Host, Place, Hash, Life, State, Mail) :-
    agent_module(Id, Place, Hash, State, Module),
    agent_enter(Id, Host, Module, Hash, Life),
    agent_put(Id, arriving, []),
    forall(member(Message, Mail), agent_mail(Id, Message)).

%!  agent_end(+Id, +Outcome) is semidet.
%
%   Id ends.  An agent that raised is kept as faulty(Error).

agent_end(Id, raised(Error)) :-
    !,
    with_agent(Id, make_faulty(Id, Error, Host, Hops)),
    host_leave(Host),
    portable(Error, Portable),
    host_log(Host, Id, faulty(Portable)),
    print_message(error, typhon(faulty(Id, Error))),
    agent_ended(Id, raised(Portable), Hops),
    forget_faulty.
agent_end(Id, Outcome) :-
    with_agent(Id, remove(Id, Last)),
    removed(Last, Id, Outcome).

%!  agent_end(+Id, :Test, +Outcome) is semidet.
%
%   Id ends if call(Test, Status) is true of it.

agent_end(Id, Test, Outcome) :-
    with_agent(Id, ( agent_status(Id, Status, _),
                     call(Test, Status),
                     remove(Id, Last)
                   )),
    removed(Last, Id, Outcome).

remove(Id, last(Host, Hops, Status)) :-
    agent(Id, Host, _, _, Life),
    arg(2, Life, Hops),
    once(agent_status(Id, Status, Goals)),
    (   Status = transit(_, _)
    ->  hop_given_up(Id, Goals)
    ;   true
    ),
    agent_remove(Id).

removed(last(_, _, faulty(_)), Id, _) :-
    !,
    retractall(faulty(Id)).
removed(last(Host, Hops, Status), Id, Outcome) :-
    tell_of_doubt(Status, Id),
    host_leave(Host),
    host_log(Host, Id, ended(Outcome)),
    (   Outcome == failed
    ->  print_message(warning, typhon(agent_failed(Id)))
    ;   true
    ),
    agent_ended(Id, Outcome, Hops).

tell_of_doubt(transit(Address, _), Id) :-
    !,
    print_message(warning, typhon(ended_in_doubt(Id, Address))).
tell_of_doubt(_, _).

make_faulty(Id, Error, Host, Hops) :-
    agent(Id, Host, _, _, Life),
    arg(2, Life, Hops),
    agent_put(Id, faulty(Error), []),
    assertz(faulty(Id)).

portable(Error, Portable) :-
    catch(( mobile_term(Error), Portable = Error ),
          error(_, _),
          term_to_atom(Error, Portable)).

%   The oldest faulty agents go when there are too many.

forget_faulty :-
    setting(faulty, Max),
    findall(Id, faulty(Id), Ids),
    length(Ids, Count),
    Excess is Count-Max,
    forall(( nth1(N, Ids, Oldest), N =< Excess ),
           ignore(agent_end(Oldest, disposed))).

%!  agent_clone_here(+Id, +CloneId, +Host, +Goals, -Answer) is det.
%
%   Make a clone of Id beside it, with Goals to do.

agent_clone_here(Id, CloneId, Host, Goals, Answer) :-
    agent(Id, Host, Module, Hash, Life0),
    agent_state(Module, State),
    Life0 = life(_, _, Lifetime, Tokens, Payloads, Static),
    Life = life(Id, 0, Lifetime, Tokens, Payloads, Static),
    agent_start(CloneId, Host, start(Hash, Life, State, Goals, []), Answer).
