:- module(disk_main, [main/0]).
:- use_module(common).
:- use_module(failing_disk, [disk_fails/1, disk_heals/0]).
:- use_module(stores).
:- use_module(library(lists), [member/2]).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/base/on_demand), [on_demand_load/2]).

/** <module> A store on a disk that fails and heals, in a process of its own

    swipl -g main disk_main.pl -- write-28 Dir

prints [While, Healed, Reopened, Numbers]: the errors of commits while the disk
fails, after it has healed, and after the store was reopened, each `space`,
`unwritten` or `none`; and the numbers of the items in the store then.

*Threading*: the main thread.
*/

main :-
    current_prolog_flag(argv, [Call0, Dir|_]),
    term_to_atom(Call, Call0),
    on_demand_load(host_option, journal),
    with_store(Dir, full, ( commit([a-k-0-first]),
                            disk_fails(Call),
                            commits(1, While),
                            disk_heals,
                            commits(2, Healed) )),
    with_store(Dir, full, ( commits(3, Reopened), items(a, Items) )),
    findall(N, ( member(_-N-_, Items), N > 0 ), Numbers0),
    (   While == space
    ->  Numbers = [1|Numbers0]          % the caller would try again
    ;   Numbers = Numbers0
    ),
    print([While, Healed, Reopened, Numbers]).

commits(N, Error) :-
    catch(( commit([a-k-N-item]), Error = none ), error(Formal, _),
          named(Formal, Error)).

named(resource_error(journal_space), space).
named(journal_unwritten(_, _), unwritten).
