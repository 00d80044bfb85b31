:- module(test_locale, []).

% Text in letters beyond ASCII is the same in any locale; many machines have
% none, and by default 9.0.4 reads files in the encoding of the locale.

:- use_module('../lib/common').
:- use_module('../lib/study_files',
              [save_lines/3, study_command/4, with_study_file/4]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).
:- use_module(library(readutil), [read_file_to_string/3]).

locale('C').
locale('C.UTF-8').

:- meta_predicate in_locale(+, 0).

in_locale(Locale, Goal) :-
    setup_call_cleanup(setenv('LC_ALL', Locale), once(Goal),
                       unsetenv('LC_ALL')).

%   prints(+Goal, +Locale, +Dir, -Out): the output of Prolog in that locale.

prints(Goal, Locale, Dir, Out) :-
    project_file(prolog, Prolog),
    atom_concat('library=', Prolog, Library),
    format(atom(Text), '~q', [Goal]),
    in_locale(Locale,
              run_swipl(['-p', Library, '-g', Text, '-t', halt],
                        [cwd(Dir)], exit(0), Out, "")).

file(Dir, Name, Text) :-
    directory_file_path(Dir, Name, File),
    read_file_to_string(File, Text, [encoding(utf8)]).

contains(Text, Part) :-
    assertion(sub_string(Text, _, _, _, Part)).

:- begin_tests(letters).

test(letters_in_a_study, forall(locale(Locale))) :-
    with_study_file([ 'study(size, "Die Größe von δ").',
                      'vary(a, [1]).',
                      'run(_, _) :- true.',
                      'measure(m, _, 1).',
                      'claim("δ > 0", [], m > 0).' ],
                    Dir, File, study_made(Locale, Dir, File)).
test(letters_in_an_agent_and_its_log) :-
    findall(Log, ( locale(Locale), with_tmp_dir(logged(Locale, Log)) ),
            [Log, Again]),
    assertion(Log == Again).
test(letters_in_a_program_of_tartarus, forall(locale(Locale))) :-
    with_tmp_dir(Dir,
        ( save_lines(Dir, 'letters.pl', ['word(\'Größe\').']),
          prints(( use_module(library(tartarus)),
                   assert_file_to_tartarus('letters.pl'),
                   word(Word),
                   atom_codes(Word, Codes),
                   print(Codes) ), Locale, Dir, Out),
          string_codes("Größe", Codes),
          term_string(Codes, Out) )).

:- end_tests(letters).

study_made(Locale, Dir, File) :-
    in_locale(Locale,
              study_command(Dir, [File, '--runs', 1, '--out', out], exit(0),
                            Text)),
    contains(Text, "size: Die Größe von δ"),
    assertion(\+ sub_string(Text, _, _, _, "Warning")),
    forall(member(Name, ['out/size/claims.csv', 'out/index.html']),
           ( file(Dir, Name, Shown), contains(Shown, "δ") )).

logged(Locale, Log, Dir) :-
    save_lines(Dir, 'letters.pl',
               [ ':- agent(letters, [state([word/1])]).',
                 'word(\'Größe\').',
                 'main :- next_host(random, Host), move(Host), word(Word),',
                 '    log(word(Word, "δ")), result(Word).' ]),
    prints(( use_module(library(typhon)),
             network_start(ring(3), N,
                           [clock(virtual), seed(1), log('events.pl')]),
             network_property(N, hosts([Host|_])),
             agent_create('letters.pl', A, [host(Host)]),
             agent_join(A, done, 10),
             agent_result(A, Word, 10),
             network_stop(N),
             atom_codes(Word, Codes),
             print(Codes) ), Locale, Dir, Out),
    string_codes("Größe", Codes),
    term_string(Codes, Out),
    file(Dir, 'events.pl', Log).

