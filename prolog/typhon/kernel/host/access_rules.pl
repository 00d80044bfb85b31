:- module(typhon_access_rules,
          [ peer_may/3,                 % +Peer, +Host, +Right
            audit/3,                    % +Host, +Peer, +What
            audit/4                     % +Host, +Peer, +Proof, +What
          ]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(error), [domain_error/2, must_be/2]).
:- use_module(library(lists), [member/2]).
:- use_module('../base/error_text', [print_error/2]).
:- use_module('../wire', [endpoint_own_proof/1, endpoint_proof/2]).
:- use_module(hosts, [host_option/2]).

/** <module> Which process may do what on a host

The option peer(Rules) of a host is a list of Peer-Rights.  Peer is `cookie`,
certificate(Name), or a pattern of these; Rights is `all` or a list out of

  - agents: create agents here, and let them come
  - messages: send messages to agents here
  - orders: dispose of them, move, change them; link the host
  - remote: run goals here, see remote/2
  - watch: look at agents and at the properties of the host

The first rule that matches the peer counts; without a match it has no right.
Without rules, a peer with the cookie has all rights; with TLS, a peer with
our own certificate has, and one with another, all but `remote`.

With the option audit(File) each refusal, order and remote goal is a line there,

    audit(Time, Host, Peer, Proof, What).

  | What                   |                                               |
  | ---------------------- | --------------------------------------------- |
  | refused(Agent, Reason) | the host did not admit Agent, see typhon_gate |
  | refused(Right)         | Peer does not have that Right                 |
  | refused(Id, from(Other)) | Id got no message of Peer's in Other's name |
  | order(Agent, Order)    | Peer gave that order to Agent                 |
  | remote(Goal)           | Peer had Goal run                             |

*Threading*: any thread; a mutex keeps lines whole.
*/


:- multifile
    typhon_host_parts:changeable/1,
    typhon_host_parts:check/1,
    typhon_host_parts:changes/2,
    typhon_host_parts:part/4.

typhon_host_parts:check(Options) :-
    forall(member(peer(Rules), Options), must_be_peer_rules(Rules)).

typhon_host_parts:changeable(audit(_)).
typhon_host_parts:changeable(peer(_)).

typhon_host_parts:changes(peer(Rules), _) :-
    must_be_peer_rules(Rules).

typhon_host_parts:part(admit, Host, 10, typhon_access_rules:forbids) :-
    host_option(Host, peer(_)).

:- public forbids/4.

forbids(from(Peer, _, _), _, Host, refused(peer)) :-
    \+ peer_permitted(Peer, Host, agents).

right(agents).
right(messages).
right(orders).
right(remote).
right(watch).

%   @error domain_error(peer_rule, Rule)

must_be_peer_rules(Rules) :-
    must_be(list, Rules),
    maplist(must_be_rule, Rules).

must_be_rule(Rule) :-
    (   nonvar(Rule),
        Rule = Peer-Rights,
        \+ \+ member(Peer, [cookie, certificate(_)]),
        rights(Rights)
    ->  true
    ;   domain_error(peer_rule, Rule)
    ).

rights(Rights) :-
    Rights == all,
    !.
rights(Rights) :-
    is_list(Rights),
    forall(member(Right, Rights), ( ground(Right), right(Right) )).

%!  peer_may(+Peer, +Host, +Right) is semidet.
%
%   The process at the address Peer has Right on Host.  peer_may/3 audits the
%   refusal.

peer_may(Peer, Host, Right) :-
    (   peer_permitted(Peer, Host, Right)
    ->  true
    ;   audit(Host, Peer, refused(Right)),
        fail
    ).

peer_permitted(Peer, Host, Right) :-
    (   host_option(Host, peer(Rules))
    ->  endpoint_proof(Peer, Proof),
        by_rules(Rules, Proof, Right)
    ;   Right \== remote
    ->  true
    ;   endpoint_proof(Peer, Proof),
        endpoint_own_proof(Proof)
    ),
    !.

by_rules(Rules, Proof, Right) :-
    member(Peer-Rights, Rules),
    subsumes_term(Peer, Proof),
    !,
    (   Rights == all
    ->  true
    ;   memberchk(Right, Rights)
    ).

%!  audit(+Host, +Peer, +What) is det.
%!  audit(+Host, +Peer, +Proof, +What) is det.
%
%   Proof is how Peer has proved itself, which audit/3 looks up.

audit(Host, Peer, What) :-
    endpoint_proof(Peer, Proof),
    audit(Host, Peer, Proof, What).

audit(Host, Peer, Proof, What) :-
    debug(typhon(audit), '~w at ~w: ~p', [Peer, Host, What]),
    (   host_option(Host, audit(File))
    ->  get_time(Time),
        catch(with_mutex(typhon_audit,
                         note(File, audit(Time, Host, Peer, Proof, What))),
              error(Formal, Context),
              print_error(error, error(Formal, Context)))
    ;   true
    ).

%   What a stranger has said is written so that it can be read again, and not
%   at any length.

note(File, Entry) :-
    setup_call_cleanup(
        open(File, append, Out, [encoding(utf8)]),
        write_term(Out, Entry,
                   [ quoted(true), ignore_ops(true), max_depth(20),
                     fullstop(true), nl(true) ]),
        close(Out)).
