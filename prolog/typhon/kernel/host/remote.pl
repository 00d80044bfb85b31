:- module(typhon_remote,
          [ remote/2,                   % +Host, +Goal
            host_do/2,                  % +Name, +Goal
            host_unknown/1,             % +Address
            peer_may/3,                 % +Peer, +Host, +Right
            security_event/2,           % +Host, +What
            security_event/3            % +Host, +Peer, +What
          ]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(error),
              [existence_error/2, must_be/2, permission_error/3]).
:- use_module(library(lists), [member/2]).
:- use_module('../base/error_text', [harmless_error/2]).
:- use_module('../wire',
              [ endpoint_address/1, endpoint_own_proof/1, endpoint_proof/2,
                endpoint_reply/2, mobile_term/1 ]).
:- use_module(runtime, [process_ask/6]).
:- use_module(turns, [in_context/2]).
:- use_module(host_names, [host_resolve/2]).
:- use_module(host_parts, [parts/3]).
:- use_module(hosts, [host/3, host_option/2]).
:- use_module(scheduler, [scheduler_call/1]).

/** <module> What other processes may do on a host, and goals that they run

remote/2 is for administrators: a process that has the cookie can run any goal
on a host, unless the host was started with remote(false).

The rights are

  - agents: create agents here, and send agents here
  - messages: send messages to agents here
  - orders: dispose of agents, move and change them; link the host
  - remote: run goals here
  - inspect: read agents, events and the properties of the host

A peer has all of these rights, but `remote` only if it proves that it has the
secret of this process: the cookie, or, where processes have keys, its
certificate.
The parts of a host in the phase `permit` can decide otherwise, and those in
the phase `security` record security events; see typhon_host_parts.

*Threading*: the goal runs in the calling thread, or in a worker of the other
process.
*/

:- multifile
    typhon_endpoint:requested/4,
    typhon_handshake:text_only/1.

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
    !,
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

typhon_endpoint:requested(remote, remote(Name, Goal), Peer, ReplyTo) :-
    (   host(Name, _, _)
    ->  may_remote(Peer, Name, Goal, ReplyTo)
    ;   endpoint_reply(ReplyTo, unknown_host)
    ).

may_remote(Peer, Name, Goal, ReplyTo) :-
    (   peer_may(Peer, Name, remote)
    ->  security_event(Name, Peer, remote(Goal)),
        scheduler_call(typhon_remote:serve(Name, Goal, ReplyTo))
    ;   endpoint_reply(ReplyTo,
                       raised(error(permission_error(remote, host, Name), _)))
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

                /*******************************
                *            RIGHTS            *
                *******************************/

%!  peer_may(+Peer, +Host, +Right) is semidet.
%
%   The process at the address Peer has Right on Host.  A denial is a security
%   event.

peer_may(Peer, Host, Right) :-
    (   permitted(Peer, Host, Right)
    ->  true
    ;   security_event(Host, Peer, refused(Right)),
        fail
    ).

permitted(_, Host, Right) :-
    Right \== remote,
    \+ parts(permit, Host, _),
    !.
permitted(Peer, Host, Right) :-
    endpoint_proof(Peer, Proof),
    proof_may(Proof, Host, Right).

proof_may(Proof, Host, Right) :-
    parts(permit, Host, Closures),
    !,
    forall(member(Closure, Closures), call(Closure, Proof, Right)).
proof_may(Proof, _, remote) :-
    endpoint_own_proof(Proof),
    !.

%   A peer that may not run goals here must not be able to end the process by a
%   binary record either.  The codec of a session is chosen when the session
%   begins.

typhon_handshake:text_only(Proof) :-
    (   host(Host, _, _)
    *-> \+ ( proof_may(Proof, Host, remote),
             \+ host_option(Host, remote(false)) )
    ;   \+ endpoint_own_proof(Proof)
    ),
    !.

%!  security_event(+Host, +What) is det.
%!  security_event(+Host, +Peer, +What) is det.
%
%   Report What, which this process, or the process at the address Peer, did, or
%   was refused, on Host.  What is one of
%
%   | refused(Agent, Reason)   | Host did not admit Agent, see typhon_gate    |
%   | refused(Right)           | Peer does not have that Right               |
%   | refused(Id, from(Other)) | Id got no message of Peer's in Other's name |
%   | over(Agent, What)        | Agent passed this limit, and ended          |
%   | cell(Agent, Reason)      | the process of Agent was ended for breaking |
%   |                          | a rule, or ended itself                     |
%   | order(Agent, Order)      | Peer gave that order to Agent               |
%   | remote(Goal)             | Peer ran Goal here                          |

security_event(Host, What) :-
    endpoint_address(Own),
    endpoint_own_proof(Proof),
    security_event(Host, Own, Proof, What).

security_event(Host, Peer, What) :-
    endpoint_proof(Peer, Proof),
    security_event(Host, Peer, Proof, What).

security_event(Host, Peer, Proof, What) :-
    debug(typhon(security), '~w at ~w: ~p', [Peer, Host, What]),
    (   parts(security, Host, Closures)
    ->  forall(member(Closure, Closures),
               call(Closure, Host, Peer, Proof, What))
    ;   true
    ).
