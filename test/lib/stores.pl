:- module(test_stores,
          [ with_store/2,               % +Where, :Goal
            with_store/3,               % +Where, +Sync, :Goal
            commit/1,                   % +Specs
            items/2,                    % +Kind, -Items
            stored/1,                   % -What
            store_keeps/2,              % +What, +Where
            while_open_elsewhere/3,     % +Where, -Pid, :Goal
            while_open_elsewhere/4      % +Before, +Where, -Pid, :Goal
          ]).

/** <module> The store of a journal, for tests

*Threading*: the main thread of a test.
*/

:- use_module(common, [project_file/2, with_swipl/5]).
:- use_module(library(lists), [member/2, numlist/3]).
:- use_module(library(readutil), [read_line_to_string/2]).
:- use_module(library(typhon/options/journal/store)).

:- meta_predicate
    with_store(+, 0),
    with_store(+, +, 0),
    while_open_elsewhere(+, -, 0),
    while_open_elsewhere(+, +, -, 0).

%!  with_store(+Where, :Goal) is semidet.
%!  with_store(+Where, +Sync, :Goal) is semidet.
%
%   Calls Goal once while the store at Where is open, see journal_place/2. Sync
%   is `full` or by default `normal`.

with_store(Where, Goal) :-
    with_store(Where, normal, Goal).

with_store(Where, Sync, Goal) :-
    setup_call_cleanup(journal_open(Where, Sync), once(Goal), store_close).

%!  commit(+Specs:list) is det.
%!  items(+Kind, -Items:list) is det.
%
%   Specs are committed, each a change or Kind-Key-N-Term, to be put; Items are
%   Key-N-Term.

commit(Specs) :-
    findall(Change, ( member(Spec, Specs), change(Spec, Change) ), Changes),
    store_commit(Changes).

change(Kind-Key-N-Term, put(Kind, Key, N, Bytes)) :-
    !,
    fast_term_serialized(Term, Bytes).
change(Change, Change).

items(Kind, Items) :-
    findall(Key-N-Value, journal_item(Kind, numbers, Key, N, Value), Items).

%!  stored(-What) is nondet.
%!  store_keeps(+What, +Where) is semidet.
%
%   The store at Where, which is empty, keeps What.

stored(What) :-
    clause(store_keeps(What, _), _).

store_keeps(committed_changes, Where) :-
    with_store(Where, commit([ a-'kéy'-1-f(X, Y, X, Y), a-other-2-[],
                               b-'kéy'-0-"é" ])),
    with_store(Where, ( items(a, [K-1-F, other-2-[]]), items(b, [_-0-B]) )),
    K-B == 'kéy'-"é",
    F =@= f(X, Y, X, Y).
store_keeps(no_part_of_uncommitted_changes, Where) :-
    with_store(Where, commit([a-k-1-one])),
    catch(with_store(Where, commit([a-k-2-two, no_change])), error(E, _), true),
    nonvar(E),
    with_store(Where, items(a, Items)),
    Items == [k-1-one].
store_keeps(the_order_of_changes, Where) :-
    with_store(Where,
               ( commit([a-k-1-x, a-k-2-y, a-k-3-z, a-l-1-w, drop(a, k, 2)]),
                 commit([drop_below(a, k, 3), a-k-9-v, a-k-9-u]),
                 commit([a-m-7-t, drop_all(a, m)]),
                 items(a, Items) )),
    Items == [l-1-w, k-3-z, k-9-u].
store_keeps(long_terms_replaced_by_short_ones, Where) :-
    forall(member(Length, [10, 20000, 300000, 15000, 5]),
           ( numlist(1, Length, List),
             with_store(Where, commit([a-k-0-List])),
             with_store(Where, items(a, [k-0-Found])),
             Found == List )),
    numlist(1, 100000, Long),
    with_store(Where, ( commit([a-k-0-Long]), commit([drop(a, k, 0)]) )),
    with_store(Where, items(a, [])).

%!  while_open_elsewhere(+Where, -Pid, :Goal) is semidet.
%!  while_open_elsewhere(+Before, +Where, -Pid, :Goal) is semidet.
%
%   Goal is called once while the store at Where is open in the process Pid,
%   which has called Before.

while_open_elsewhere(Where, Pid, Goal) :-
    while_open_elsewhere(true, Where, Pid, Goal).

while_open_elsewhere(Before, Where, Pid, Goal) :-
    project_file('prolog/typhon.pl', Library),
    project_file('prolog/typhon/options/journal/store.pl', Store),
    format(atom(Opens), '~q, ~q, journal_open(~q, normal), writeln(open), \c
                         flush_output, read(_)',
           [use_module(Store), Before, Where]),
    with_swipl(['-g', Opens, '-t', halt, Library], Pid, _, Out,
               ( read_line_to_string(Out, "open"),
                 call(Goal) )).
