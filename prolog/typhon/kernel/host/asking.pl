:- module(typhon_asking,
          [ process_ask/6,              % +Endpoint, +Host, +Kind, +Term,
                                        % -Answer, +Seconds
            as_guest/1                  % :Goal
          ]).
:- use_module('../wire',
              [endpoint_call/5, endpoint_missed/2]).
:- use_module(runtime,
              [runtime_acquire/2, runtime_release/1, runtime_user/1]).

/** <module> Questions to other processes

A process without hosts is a guest in the network for as long as a question
takes: it has an endpoint of its own until the answer is there.

*Threading*: any thread that may wait.  The platform's own are no guests:
stopping it waits for them.
*/

:- meta_predicate as_guest(0).

%!  process_ask(+Endpoint, +Host, +Kind, +Term, -Answer, +Seconds) is det.
%
%   As endpoint_call/5; errors name the process as Host.
%
%   @error host_unreachable(Host)
%   @error permission_error(authenticate, host, Host): the process there has
%   another cookie than this one
%   @error those of endpoint_call/5

process_ask(Endpoint, Host, Kind, Term, Answer, Seconds) :-
    as_guest(catch(endpoint_call(Endpoint, Kind, Term, answer(Answer),
                                 Seconds),
                   error(unreachable(_), _),
                   unreachable(Endpoint, Host))).

unreachable(Endpoint, Host) :-
    (   endpoint_missed(Endpoint, permission_error(authenticate, peer, cookie))
    ->  Formal = permission_error(authenticate, host, Host)
    ;   Formal = host_unreachable(Host)
    ),
    throw(error(Formal, _)).

%!  as_guest(:Goal) is semidet.
%
%   Run Goal once; if this process has no endpoint, or has it for the sake of
%   other guests only, it has one meanwhile.

as_guest(Goal) :-
    (   runtime_user(User),
        User \= guest(_)
    ;   own_thread
    ),
    !,
    once(Goal).
as_guest(Goal) :-
    flag(typhon_guest, N, N+1),
    runtime_acquire(guest(N), []),
    setup_call_cleanup(true, once(Goal), runtime_release(guest(N))).

own_thread :-
    thread_self(Me),
    atom(Me),
    sub_atom(Me, 0, _, _, typhon_).
