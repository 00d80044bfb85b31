:- module(test_played, []).
:- use_module('../lib/common').
:- use_module('../lib/virtual_documents').
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).
:- use_module(library(process), [process_create/3, process_wait/2]).

/** <module> Programs in virtual time give the same logs in every Prolog

Seven documents that the playground offers are played in this Prolog, and in those
that TYPHON_RING names, one of them of another word size: see test_ring.pl and
test/portability/run --boards. Answers and logs are compared byte by byte.

*Threading*: the main thread.
*/

:- begin_tests(played_by_other_prologs).

test(same_bytes, [ condition(getenv('TYPHON_RING', _)),
                   forall(played_document(Document)),
                   Different-Document == []-Document ]) :-
    prologs(Prologs),
    tmp_file(played, Dir),
    maplist(played(Document, Dir), Prologs, Folders),
    contents_differ(Folders, Different).

:- end_tests(played_by_other_prologs).

prologs([Swipl|Others]) :-
    current_prolog_flag(executable, Swipl),
    getenv('TYPHON_RING', Value),
    atomic_list_concat(Others, :, Value).

%   Others take minutes by qemu.

played_document(Document) :-
    member(Name, [ algorithms, classics, 'course/1-first-agent',
                   'course/2-stigmergy', 'course/3-election',
                   'course/4-contract-net', 'course/5-ant-routing' ]),
    atomic_list_concat(['doc/', Name, '.md'], Document).

played(Document, Dir, Prolog, Contents) :-
    project_file('.', Root),
    process_create(Prolog,
                   [ '-g', play, '-t', halt, 'test/portability/player.pl', --,
                     Document, Dir ],
                   [ stdin(null), stdout(pipe(Out)), stderr(null), cwd(Root),
                     process(Pid) ]),
    call_cleanup(read_term(Out, played(Contents), []), close(Out)),
    process_wait(Pid, exit(0)).
