:- module(typhon_access, []).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(error), [domain_error/2, must_be/2]).
:- use_module(library(lists), [member/2]).
:- use_module(library(terms), [mapargs/3]).
:- use_module('../kernel/base/error_text',
              [abridged/3, is_tree/2, print_error/2]).
:- use_module('../kernel/base/private', [output_file/2, private_open/4]).
:- use_module('../kernel/base/text', [write_portable/3]).
:- use_module('../kernel/wire', [endpoint_proof/2, right/3]).
:- use_module('../kernel/host', [host_option/2]).

/** <module> Access rules for peers, and the audit log

The option peer(Rules) of a host is a list of Peer-Rights.  Peer is `cookie`,
certificate(Name), or a pattern of these; Rights is `all` or a list of rights,
see typhon_kinds.  Rules call the right `inspect` `watch`.  The first rule that
matches the proof of a peer applies; a peer without a matching rule has no
right.

With the option audit(File) each security event appends a line to File,

    audit(Time, Host, Peer, Proof, What).

*Threading*: any thread; a mutex keeps lines from being mixed.
*/

:- multifile
    typhon_host_parts:changeable/1,
    typhon_host_parts:changes/2,
    typhon_host_parts:check/1,
    typhon_host_parts:part/4,
    typhon_options:declared/4,
    typhon_private:begins/2.

typhon_private:begins(audit, "audit(").

typhon_options:declared(host_option, peer(Rules), list, Rules).
typhon_options:declared(host_option, audit(File), text, File).

typhon_host_parts:check(Options) :-
    forall(member(peer(Rules), Options), must_be_peer_rules(Rules)),
    forall(member(audit(File), Options), output_file(audit, File)).

typhon_host_parts:changeable(audit(_)).
typhon_host_parts:changeable(peer(_)).

typhon_host_parts:changes(audit(File), _) :-
    output_file(audit, File).
typhon_host_parts:changes(peer(Rules), _) :-
    must_be_peer_rules(Rules).

typhon_host_parts:part(admit, Host, 10, typhon_access:forbids(Rules)) :-
    once(host_option(Host, peer(Rules))).
typhon_host_parts:part(permit, Host, 10, typhon_access:permits(Rules)) :-
    once(host_option(Host, peer(Rules))).
typhon_host_parts:part(security, Host, 10, typhon_access:note(File)) :-
    once(host_option(Host, audit(File))).

                /*******************************
                *             RULES            *
                *******************************/

:- public forbids/5, permits/3, note/5.

%   forbids(+Rules, +From, +Entrant, +Host, -Verdict): see typhon_gate.

forbids(Rules, from(Peer, _, _), _, _, refused(peer)) :-
    endpoint_proof(Peer, Proof),
    \+ permits(Rules, Proof, agents).

%   permits(+Rules, +Proof, +Right): see typhon_host_parts.

permits(Rules, Proof, Right) :-
    member(Peer-Rights, Rules),
    subsumes_term(Peer, Proof),
    !,
    (   Rights == all
    ->  true
    ;   memberchk(Right, Rights)
    ).

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
    (   Rights == all
    ->  true
    ;   is_list(Rights),
        forall(member(Right, Rights), ( ground(Right), right(Right, _, _) ))
    ).

%   note(+File, +Host, +Peer, +Proof, +What): Proof is how Peer has proved its
%   identity; What is that of security_event/3.

note(File, Host, Peer, Proof, What0) :-
    get_time(Time),
    brief(What0, What),
    catch(with_mutex(typhon_audit,
                     append_line(File,
                                 audit(Time, Host, Peer, Proof, What))),
          error(Formal, Context),
          print_error(error, error(Formal, Context))).

%   brief(+Term0, -Term): replace large subterms of Term0 by abridged text.
%   Otherwise a peer, or a cell, could fill the disk with large entries.

brief(Term0, Term) :-
    is_short(Term0),
    !,
    Term = Term0.
brief(Term0, Term) :-
    compound(Term0),
    compound_name_arity(Term0, Name, Arity),
    Arity =< 3,
    is_short(Name),
    Term0 \= [_|_],
    !,
    mapargs(brief, Term0, Term).
brief(Term0, large(Text)) :-
    abridged(Term0, 100, Text).

is_short(Term) :-
    is_tree(Term, 500),
    format(string(Text), '~q', [Term]),
    string_length(Text, Length),
    Length < 2000.

%   The entry holds text that the peer chose: quoting keeps the log readable by
%   read/1, and on one line without hidden characters.

append_line(File, Entry) :-
    setup_call_cleanup(
        private_open(File, append, Out, [encoding(utf8)]),
        write_portable(Out, Entry,
                       [ignore_ops(true), fullstop(true), nl(true)]),
        close(Out)).
