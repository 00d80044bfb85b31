:- module(typhon_remote,
          [ remote/2,                   % +Host, +Goal
            host_do/2,                  % +Name, +Goal
            host_unknown/1              % +Address
          ]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(error),
              [existence_error/2, must_be/2, permission_error/3]).
:- use_module('../base/error_text', [harmless_error/2]).
:- use_module('../wire',
              [endpoint_reply/2, mobile_term/1]).
:- use_module(runtime, [process_ask/6]).
:- use_module(turns, [in_context/2]).
:- use_module(hosts, [host/3, host_option/2, host_resolve/2]).
:- use_module(scheduler, [scheduler_call/1]).

/** <module> Goals that other processes run on a host

remote/2 is for administrators: a process that has the right `remote`, see
typhon_rights, can run any goal on a host, unless the host was started with
remote(false).

*Threading*: the goal runs in the calling thread, or in a worker of the other
process.
*/

:- multifile typhon_endpoint:requested/4.

%!  remote(+Host, +Goal) is semidet.
%
%   Call once(Goal) in the place of Host, in this or another process. Bindings,
%   failure and errors are returned. An error of another process whose message
%   would call a goal is returned as error(raised_elsewhere(Ball), _). A goal
%   M:G runs in module M instead, and has the place only as its context.
%   leave/1, sense/1 and take/1 work on the tuple space of Host.
%
%   @error permission_error(remote, host, Host) if the host refuses
%   @error host_unreachable(Host), permission_error(authenticate, host, Host)
%   @error connection_lost(Host): it is not known whether Goal ran

remote(Host, Goal) :-
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

%!  host_unknown(+Address) is failure.
%
%   The process of Address has no such host: raise an error that lists its
%   hosts.
%
%   @error existence_error(host, Address)

host_unknown(Address) :-
    host_resolve(Address, remote(_, _, Endpoint)),
    catch(process_ask(Endpoint, Address, hosting, hosts, Names, 10),
          error(_, _), fail),
    Names = [_|_],
    atomic_list_concat(Names, ', ', Listed),
    atom_concat('there are: ', Listed, Text),
    throw(error(existence_error(host, Address), context(_, Text))).
host_unknown(Address) :-
    existence_error(host, Address).

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
