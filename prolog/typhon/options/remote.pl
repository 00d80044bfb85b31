:- module(typhon_remote,
          [ run_remote/2,               % +Host, +Goal
            host_do/2                   % +Name, +Goal
          ]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(error), [must_be/2, permission_error/3]).
:- use_module('../kernel/base/error_lines', [harmless_error/2]).
:- use_module('../kernel/wire', [endpoint_reply/2, mobile_term/1]).
:- use_module('../kernel/host',
              [ host/3, host_option/2, host_resolve/2, host_unknown/1,
                in_context/2, process_ask/6, scheduler_call/1 ]).

/** <module> Goals that other processes run on a host

remote/2 is for administrators: a process that has the right `remote`, see
typhon_rights, can run any goal on a host, unless the host was started with
remote(false).

*Threading*: the goal runs in the calling thread, or in a worker of the other
process.
*/

:- multifile typhon_endpoint:requested/4.

%!  run_remote(+Host, +Goal) is semidet.
%
%   See remote/2.

run_remote(Host, Goal) :-
    host_resolve(Host, Where),
    must_be(callable, Goal),
    once(run(Where, Goal)).

run(local(Name), Goal) :-
    run_here(Name, Goal).
run(remote(Host, Name, Endpoint), Goal) :-
    mobile_term(Goal),
    catch(process_ask(Endpoint, Host, remote, remote(Name, Goal), Answer,
                      1.0e9),
          error(connection_lost(_), _),
          throw(error(connection_lost(Host), _))),
    conclude(Answer, Host, Goal).

conclude(true(Goal), _, Goal).
conclude(raised(Ball0), _, _) :-
    harmless_error(Ball0, Ball),
    throw(Ball).
conclude(unknown_host, Host, _) :-
    host_unknown(Host).

run_here(Name, Goal) :-
    (   host_option(Name, remote(false))
    ->  permission_error(remote, host, Name)
    ;   host_do(Name, Goal)
    ).

%!  host_do(+Name, +Goal) is semidet.
%
%   As remote/2 on a host of this process, even if it has remote(false).

host_do(Name, Goal) :-
    host(Name, _, Place),
    in_context(Name, Place:Goal).

typhon_endpoint:requested(remote, remote(Name, Goal), _, ReplyTo) :-
    (   host(Name, _, _)
    ->  scheduler_call(typhon_remote:serve(Name, Goal, ReplyTo))
    ;   endpoint_reply(ReplyTo, unknown_host)
    ).

serve(Name, Goal, ReplyTo) :-
    debug(typhon(host), 'remote(~w, ~p) of another process', [Name, Goal]),
    catch(outcome(Name, Goal, Answer), Ball, raised(Ball, Answer)),
    endpoint_reply(ReplyTo, Answer).

%   A term that cannot be sent is replaced by its text: the caller must get an
%   answer.

raised(Ball, raised(Portable)) :-
    catch(( mobile_term(Ball), Portable = Ball ),
          error(type_error(mobile_term, _), _),
          portable(Ball, Portable)).

portable(Ball, Portable) :-
    (   Ball = error(Formal, _),
        catch(mobile_term(Formal), error(type_error(mobile_term, _), _), fail)
    ->  Portable = error(Formal, _)
    ;   Ball = error(type_error(mobile_term, Culprit), _)
    ->  format(atom(Text), '~q', [Culprit]),
        Portable = error(type_error(mobile_term, Text), _)
    ;   format(atom(Text), '~q', [Ball]),
        Portable = error(system_error(Text), _)
    ).

outcome(Name, Goal, Answer) :-
    (   run_here(Name, Goal)
    ->  mobile_term(Goal),
        Answer = true(Goal)
    ;   Answer = false
    ).
