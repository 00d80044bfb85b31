:- module(test_births, []).
:- use_module('../../../lib/common').
:- use_module('../../../lib/authority').
:- use_module('../../../lib/fixtures').
:- use_module(library(plunit)).
:- use_module(library(lists), [member/2]).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/wire), [endpoint_address/1]).
:- use_module('../../../../prolog/typhon/options/identity/birth',
              [agent_owned/2, birth_good/1]).
:- use_module('../../../../prolog/typhon/options/identity/signatures', []).
:- use_module('../../../../prolog/typhon/options/identity/sender_rights', []).
:- use_module('../../../../prolog/typhon/options/keys', [keys_sign/3]).

:- needs([openssl]).

/** <module> Which process owns an agent, and may speak for it

The process has the keys of beta; agents are of alpha.

*Threading*: one test at a time.
*/

made :-
    authority_begin([alpha,beta], [alice]),
    authority_keys(beta, Beta),
    assertz(typhon_keys:own_keys(Beta)).

removed :-
    retractall(typhon_keys:own_keys(_)),
    forgotten,
    authority_end.

forgotten :-
    forall(typhon_identity:ids_anew, true),
    retractall(typhon_signatures:signature(_, _)).

id('x.abc-alpha.0@alpha@127.0.0.1:9').

%   birth(+Signer, +Id, +Hash, -Birth)

birth(Signer, Id, Hash, birth(Id, Hash, Certificate, Hex)) :-
    authority_keys(Signer, Keys),
    typhon_birth:birth_text(Id, Hash, Text),
    keys_sign(Keys, Text, signature(Pem, Hex)),
    atom_string(Certificate, Pem).

good(Birth, Good) :-
    ( birth_good(Birth) -> Good = yes ; Good = no ).

%   bad(-Birth): it proves nothing.

bad(_).
bad(x).
bad(birth(Id, _, Certificate, Hex)) :-
    true(birth(Id, _, Certificate, Hex)).
bad(birth(Id, other, Certificate, Hex)) :-
    true(birth(Id, _, Certificate, Hex)).
bad(birth('y.abc-alpha.0@alpha@127.0.0.1:9', Hash, Certificate, Hex)) :-
    true(birth(_, Hash, Certificate, Hex)).
bad(birth(Id, Hash, Certificate, Hex)) :-
    true(birth(Id, Hash, Certificate, _)),
    member(Hex, ["00", x, f(x)]).
bad(birth(Id, Hash, Pem, Hex)) :-
    true(birth(Id, Hash, Certificate, Hex)),
    atom_string(Certificate, Pem).
bad(Birth) :-
    id(Id),
    member(Signer, [beta,alice]),
    birth(Signer, Id, h, Birth).
bad(Birth) :-
    member(Id, [ 'x.abc.0@alpha@127.0.0.1:9', x,
                 'x.abc-alpha.0', 'x.abc-alphaa.0@alpha@127.0.0.1:9' ]),
    birth(alpha, Id, h, Birth).
bad(Birth) :-
    endpoint_address(Here),
    atom_concat('x.abc-alpha.0@alpha@', Here, Id),
    birth(alpha, Id, h, Birth).

true(Birth) :-
    id(Id),
    birth(alpha, Id, h, Birth).

letters_split(Parts) :-
    id(Id),
    endpoint_address(Here),
    typhon_sender_authorization:split_mail(there, Id,
        [ mail(Here, 'y.abc-beta.0@beta@127.0.0.1:9', beta),
          mail(Here, 'y.abc-alpha.0@alpha@127.0.0.1:9', alpha),
          mail('127.0.0.1:8', Id, elsewhere) ], Parts).

:- begin_tests(births, [setup(made), cleanup(removed)]).

test(owner_signs_births, [cleanup(forgotten), Good == yes]) :-
    true(Birth),
    good(Birth, Good).
test(other_terms_are_no_births, [cleanup(forgotten), Taken == []]) :-
    with_hosts([g], findall(B, ( bad(B), birth_good(B) ), Taken)).
test(births_are_short, [cleanup(forgotten), Good == [yes,no]]) :-
    true(birth(_, _, Certificate, _)),
    atom_length(Certificate, Long),
    findall(G, ( member(Size, [20 000,20 001]),
                 N is Size-Long-1,
                 format(atom(Id), '~`xt.abc-alpha.0@alpha@127.0.0.1:9~*|', [N]),
                 birth(alpha, Id, h, B), good(B, G) ), Good).
test(who_has_shown_a_birth_may_send_that_program,
     [cleanup(forgotten), Proved == [yes,no,no,no]]) :-
    id(Id),
    true(Birth),
    assertz(typhon_birth:has(Id, certificate(m))),
    assertz(typhon_birth:known(Id, Birth)),
    proved([ p(known, certificate(m), Id, h), p(known, certificate(m), Id, k),
             p(known, certificate(n), Id, h), p(known, certificate(m), y, h) ],
           Proved).
test(birth_is_sent_to_a_process_that_is_not_known,
     [cleanup(forgotten), Papers == papers(Birth, sent)]) :-
    id(Id),
    true(Birth),
    assertz(typhon_birth:known(Id, Birth)),
    with_hosts([g],
               typhon_birth:papers(g, program(Id, h, '127.0.0.1:9'), sent,
                                   Papers)).
test(shown_birth_is_of_the_agent_and_its_program,
     [cleanup(forgotten), Proved == [no,no,no,yes,yes]]) :-
    id(Id),
    true(Birth),
    proved([ p(papers(Birth, x), certificate(m), Id, k),
             p(papers(Birth, x), certificate(m), y, h),
             p(papers(Birth), certificate(m), Id, h),
             p(papers(Birth, x), certificate(m), Id, h),
             p(known, certificate(m), Id, h) ], Proved).
test(agent_without_papers_is_asked_for_them, Verdicts ==
     [need_program,refused(identity)]) :-
    findall(V, ( member(P, [known,papers(x, y)]),
                 typhon_birth:unproved(P, V) ), Verdicts).
test(ids_name_their_owner,
     Owners == [alpha,'a-b','a.b','a b',none,none,none]) :-
    findall(O, ( member(Id, [ 'x.abc-alpha.0@g@h:1', 'x.abc-a-b.0@g@h:1',
                              'x.abc-a!2e!b.0@g@h:1', 'x.abc-a!20!b.1@g@h:1',
                              'x.abc.0@g@h:1', 'x-alpha.abc.0@g@h:1', x ]),
                 ( member(O, [alpha,'a-b','a.b','a b',x]), agent_owned(Id, O)
                 -> true ; O = none ) ), Owners).
test(owner_speaks_for_its_agents, [cleanup(forgotten),
     Rights == [yes,no,yes,no,no]]) :-
    id(Id),
    true(Birth),
    birth(beta, Id, h, Forged),
    findall(R, ( member(r(Proof, Births, Of),
                        [ r(certificate(alpha), [], Id),
                          r(certificate(gamma), [], Id),
                          r(certificate(gamma), [x,Birth], Id),
                          r(certificate(gamma), [Forged], Id),
                          r(certificate(gamma), [Birth], y) ]),
                 forgotten,
                 ( typhon_sender_rights:has_right(Proof, Births, Of) -> R = yes
                 ; R = no ) ), Rights).
test(letters_for_an_agent_without_birth_go_by_the_homes_of_their_senders,
     Parts == ['127.0.0.1:9'-[alpha], there-[beta,elsewhere]]) :-
    with_hosts([g],
               setup_call_cleanup(
                   asserta(typhon_transport:current(tls, certificate(beta),
                                                    certificate(x)), Ref),
                   letters_split(Parts0),
                   erase(Ref))),
    findall(Via-Names,
            ( member(Via-Mail, Parts0),
              findall(Name, member(mail(_, _, Name), Mail), Names) ),
            Parts).
test(senders_that_are_no_agents_are_accepted, Accepted == [yes,yes,no]) :-
    findall(A, ( member(From, [user,fipa(x, y),_]),
                 ( typhon_sender_rights:sender_accepted('h:1', t(t), From)
                 -> A = yes ; A = no ) ), Accepted).
test(author_of_a_program_is_known_by_its_signature,
     [cleanup(forgotten), Authors == [alice,none,none]]) :-
    authority_keys(beta, Keys),
    findall(A, ( member(Signer-Of, [alice-h,alice-k,alpha-h]),
                 forgotten,
                 authority_keys(Signer, SignerKeys),
                 keys_sign(SignerKeys, 'typhon program h', Signature),
                 typhon_signatures:signature_keep(Of, Signature),
                 ( typhon_signatures:program_author(Keys, Of, A0) -> A = A0
                 ; A = none ) ), Authors).
test(new_signature_replaces_the_former, [cleanup(forgotten), All == [s2]]) :-
    forall(member(S, ["s1","s2"]),
           typhon_signatures:signature_keep(h, signature("c", S))),
    findall(S, ( typhon_signatures:signature(h, signature(_, S0)),
                 atom_string(S, S0) ), All).
test(signatures_are_short, [cleanup(forgotten), Kept == [yes,no]]) :-
    findall(K, ( member(N, [32 767,32 768]),
                 format(string(Hex), '~*c', [N,0'0]),
                 typhon_signatures:signature_keep(N, signature("c", Hex)),
                 ( typhon_signatures:signature(N, _) -> K = yes ; K = no ) ),
            Kept).
test(term_that_is_no_signature_is_not_kept,
     [ forall(member(S, [ _, x, signature("c", _), signature(c, "h"),
                          signature("c", h), signature("c") ])),
       cleanup(forgotten), Kept == [] ]) :-
    typhon_signatures:signature_keep(h, S),
    findall(x, typhon_signatures:signature(h, _), Kept).
test(signatures_are_bounded, [cleanup(forgotten), Count-First == 1024-2]) :-
    forall(between(1, 1025, N),
           typhon_signatures:signature_keep(N, signature("c", "h"))),
    predicate_property(typhon_signatures:signature(_, _),
                       number_of_clauses(Count)),
    once(typhon_signatures:signature(First, _)).

:- end_tests(births).

proved(Cases, Proved) :-
    findall(V, ( member(p(Papers, Proof, Id, Hash), Cases),
                 ( typhon_birth:proved(Papers, Proof, Id, Hash) -> V = yes
                 ; V = no ) ), Proved).
