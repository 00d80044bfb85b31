:- module(typhon_services,
          [ service/2,                  % ?Service, ?Host
            service_begin/4,            % +Service, +Host, +PIs, +Module
            service_offer/4,            % +Name, +Host, +PIs, +Clauses
            service_end/2               % +Service, +Host
          ]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(error), [existence_error/2, permission_error/3]).
:- use_module(library(lists), [member/2]).
:- use_module('../../kernel/base/error_text', [print_error/2]).
:- use_module('../../kernel/base/own_thread', [in_own_thread/1]).
:- use_module('../../kernel/host', [host/3, place_deliver/3, place_undeliver/2]).
:- use_module(subscribers, [subscribers_forget/2]).

/** <module> Services of a place

A service is a bridge on a host.  Its predicates are in the place of the
host as if an agent had delivered them, so that agents find them there, and
nowhere else; they go when the service ends, or its host.

*Threading*: any thread may begin and end a service; one that is ended twice
at a time is ended once.
*/

:- multifile
    ends/2,                     % Service, Host: release what it holds
    typhon_hosting:evacuate/2,
    typhon_starting:stops/2.

:- dynamic
    service/2.                  % Service, Host: begun, and not ended

%!  service(?Service, ?Host) is nondet.
%
%   The services of the hosts of this process.

%!  service_begin(+Service, +Host, +PIs:list, +Module) is det.
%
%   From now on there is Service on Host: the predicates PIs of Module.
%
%   @error permission_error(start, Service, Host) if there is one
%   @error those of service_offer/4

service_begin(Service, Host, PIs, Module) :-
    with_mutex(typhon_services,
               (   service(Service, Host)
               ->  permission_error(start, Service, Host)
               ;   assertz(service(Service, Host))
               )),
    findall((Head:-Module:Head),
            ( member(Name/Arity, PIs), functor(Head, Name, Arity) ),
            Clauses),
    catch(service_offer(service(Service), Host, PIs, Clauses), Ball,
          ( retractall(service(Service, Host)),
            throw(Ball) )),
    debug(typhon(bridge), '~w is on ~w', [Service, Host]).

%!  service_offer(+Name, +Host, +PIs:list, +Clauses:list) is det.
%
%   The place offers PIs, defined by Clauses, instead of what it offered under
%   Name, which is service(Service) or that of a payload.
%
%   @error permission_error(define, vocabulary, PI) if all agents know such a
%          predicate
%   @error permission_error(deliver, procedure, PI) if the place has it
%          otherwise

service_offer(Name, Host, PIs, Clauses) :-
    forall(member(PI, PIs), unknown(PI)),
    host(Host, _, Place),
    place_deliver(Place, payload(Name, PIs, Clauses), _).

unknown(Name/Arity) :-
    functor(Head, Name, Arity),
    (   predicate_property(typhon_vocabulary:Head, defined)
    ->  permission_error(define, vocabulary, Name/Arity)
    ;   true
    ).

%!  service_end(+Service, +Host) is det.
%
%   @error existence_error(Service, Host) if it is not there

service_end(Service, Host) :-
    (   retract(service(Service, Host))
    ->  in_own_thread(typhon_services:end(Service, Host))
    ;   existence_error(Service, Host)
    ).

typhon_starting:stops(Service, Host) :-
    service(Service, Host),
    service_end(Service, Host).

%   Nothing is asked of it any more when it ends.

end(Service, Host) :-
    host(Host, _, Place),
    catch(place_undeliver(Place, service(Service)), error(_, _), true),
    subscribers_forget(Service, Host),
    catch(forall(ends(Service, Host), true), error(Formal, Context),
          print_error(warning, error(Formal, Context))),
    debug(typhon(bridge), '~w is no longer on ~w', [Service, Host]).

%   After the agents have gone.

typhon_hosting:evacuate(Host, _) :-
    end_all(Host).

end_all(Host) :-
    (   retract(service(Service, Host))
    ->  end(Service, Host),
        end_all(Host)
    ;   true
    ).
