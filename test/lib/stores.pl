:- module(test_stores,
          [ with_store/2,               % +Where, :Goal
            with_store/3,               % +Where, +Sync, :Goal
            commit/1,                   % +Specs
            items/2                     % +Kind, -Items
          ]).

/** <module> The store of a journal, for tests

*Threading*: the main thread of a test.
*/

:- use_module(library(lists), [member/2]).
:- use_module(library(typhon/options/journal/store)).

:- meta_predicate with_store(+, 0), with_store(+, +, 0).

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
