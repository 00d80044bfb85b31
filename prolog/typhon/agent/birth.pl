:- module(typhon_birth,
          [ birth_taken/4,              % +Id, +Hash, +State0, -State
            birth_left/2,               % +State0, -State
            birth_proved/3,             % +Id, +Hash, +State
            birth_good/1,               % +Birth
            birth_papers/3,             % +State, +Sent, -Papers
            birth_papers_kept/2,        % +Papers, -Sent
            birth_shown/2               % +Id, -Birth
          ]).

/** <module> Who owns an agent

Where processes have keys an agent that leaves the process in which it was
born takes along what that one has signed, a fact among its state:

    '$birth'(Id, Hash, Key, Hex)

Id is its own, and says who the owner is, see typhon_identity; Hash is that of
its program, and Key that of the certificate of the owner. Nobody else can make
one, so an id belongs to the owner, and to one program. And since it is shown
to nobody but those to whom the agent goes, and to its home, who shows it has
had the agent.

Certificates are long: they go along with programs, to who lacks them.

*Threading*: any thread; a mutex makes those who remember come one by one.
*/

:- use_module(library(apply), [exclude/3]).
:- use_module(library(lists), [memberchk/2]).
:- use_module(library(settings), [setting/4]).
:- use_module(library(sha), [hash_atom/2, sha_hash/3]).
:- use_module('../base/bounded', [bounded/2]).
:- use_module('../base/keys',
              [keys_certificate/2, keys_holder/3, keys_sign/3, keys_verify/4]).
:- use_module('../journal', [note_drop/3, note_put/4]).
:- use_module('../wire', [endpoint_address/1, endpoint_keys/1]).
:- use_module(identity,
              [agent_home_endpoint/2, agent_owned/1, agent_owned/2]).

:- multifile
    typhon_bounded:forgotten/1,
    typhon_identity:ids_anew/0,
    typhon_recovery:back/4.

:- setting(births, positive_integer, 20000,
           "Of so many agents that were here it is remembered who owns them").

:- setting(owners, positive_integer, 2000,
           "Certificates of owners that are kept").

:- dynamic
    known/2,                            % Id, Birth: a good one
    certificate/2.                      % Key, Certificate: of a host

typhon_identity:ids_anew :-
    retractall(known(_, _)).

%!  birth_taken(+Id, +Hash, +State0, -State) is det.
%
%   State, as of agent_state/2, is State0 with the birth of Id, which leaves
%   this process; or without, where nobody here can prove it.

birth_taken(Id, Hash, State0, State) :-
    State0 = state(_, Clauses),
    memberchk('$birth'(Id, Hash, _, _), Clauses),
    !,
    State = State0.
birth_taken(Id, Hash, State0, State) :-
    birth_left(State0, state(Empty, Clauses)),
    (   birth(Id, Hash, Birth)
    ->  State = state(Empty, [Birth|Clauses])
    ;   State = state(Empty, Clauses)
    ).

birth(Id, Hash, Birth) :-
    known(Id, Birth0),
    Birth0 = '$birth'(_, Hash, _, _),
    !,
    Birth = Birth0.
birth(Id, Hash, '$birth'(Id, Hash, Key, Hex)) :-
    agent_owned(Id),
    endpoint_keys(Keys),
    birth_text(Id, Hash, Text),
    keys_sign(Keys, Text, signature(Certificate, Hex)),
    certificate_keep(Certificate, Key),
    remember(Id, '$birth'(Id, Hash, Key, Hex)).

birth_text(Id, Hash, Text) :-
    atomic_list_concat(['typhon birth', Id, Hash], ' ', Text).

remember(Id, Birth) :-
    with_mutex(typhon_birth,
               ( retractall(known(Id, _)),
                 assertz(known(Id, Birth)),
                 bounded(known(_, _), typhon_birth:births) )).

%!  birth_left(+State0, -State) is det.
%
%   State is State0 without the birth of whoever it was.

birth_left(state(Empty, Clauses0), state(Empty, Clauses)) :-
    exclude(of_birth, Clauses0, Clauses).

of_birth(Clause) :-
    subsumes_term('$birth'(_, _, _, _), Clause).

%!  birth_proved(+Id, +Hash, +State) is semidet.
%
%   Among State is a good birth of Id with that program; or there are no keys
%   here.

birth_proved(Id, Hash, state(_, Clauses)) :-
    (   endpoint_keys(_)
    ->  memberchk('$birth'(Id, Hash, Key, Hex), Clauses),
        birth_good('$birth'(Id, Hash, Key, Hex))
    ;   true
    ).

%!  birth_good(+Birth) is semidet.
%
%   The owner has signed Birth, and is not revoked. Birth may be anything.

birth_good(Birth) :-
    ground(Birth),
    Birth = '$birth'(Id, Hash, Key, Hex),
    endpoint_keys(Keys),
    certificate_of(Key, Certificate),
    (   known(Id, Known),
        Known == Birth
    ->  keys_holder(Keys, Certificate, _)
    ;   atom(Id),
        atom(Hash),
        birth_text(Id, Hash, Text),
        keys_verify(Keys, Text, signature(Certificate, Hex), host(Owner)),
        agent_owned(Id, Owner),
        at_home(Id),
        remember(Id, Birth)
    ).

%   Nobody else's was born here.

at_home(Id) :-
    agent_owned(Id),
    !.
at_home(Id) :-
    agent_home_endpoint(Id, Home),
    \+ endpoint_address(Home).

%!  birth_papers(+State, +Sent, -Papers) is det.
%!  birth_papers_kept(+Papers, -Sent) is det.
%
%   What is sent instead of Sent, which goes along with an agent of that State
%   to who may lack the certificate of its owner; he keeps it, if it is one.

birth_papers(state(_, Clauses), Sent, Papers) :-
    endpoint_keys(_),
    memberchk('$birth'(_, _, Key, _), Clauses),
    certificate(Key, Certificate),
    !,
    Papers = papers(Certificate, Sent).
birth_papers(_, Sent, Sent).

birth_papers_kept(Papers, Sent) :-
    subsumes_term(papers(_, _), Papers),
    !,
    Papers = papers(Certificate, Sent),
    (   endpoint_keys(Keys),
        keys_holder(Keys, Certificate, host(_))
    ->  certificate_keep(Certificate, Key),
        note_put(owner, Key, 0, Certificate)
    ;   true
    ).
birth_papers_kept(Sent, Sent).

typhon_recovery:back(owner, _, _, Certificate) :-
    certificate_keep(Certificate, _).

typhon_bounded:forgotten(certificate(Key, _)) :-
    note_drop(owner, Key, 0).

certificate_of(Key, Certificate) :-
    certificate(Key, Certificate0),
    !,
    Certificate = Certificate0.
certificate_of(Key, Certificate) :-
    endpoint_keys(Keys),
    keys_certificate(Keys, Certificate),
    certificate_keep(Certificate, Key).

certificate_keep(Certificate, Key) :-
    sha_hash(Certificate, Bytes, [algorithm(sha256), encoding(utf8)]),
    hash_atom(Bytes, Key0),
    Key = Key0,
    (   certificate(Key, _)
    ->  true
    ;   with_mutex(typhon_birth,
                   ( assertz(certificate(Key, Certificate)),
                     bounded(certificate(_, _), typhon_birth:owners) ))
    ).

%!  birth_shown(+Id, -Birth) is semidet.
%
%   What shows that we have, or had, the agent Id of another owner.

birth_shown(Id, Birth) :-
    known(Id, Birth).
