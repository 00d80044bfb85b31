:- module(chaos_report,
          [ report_begin/3,             % +Scenario, +Seconds, +Dir
            report/6,                   % +Scenario, +Dir, +Events,
                                        % +Evidence, +Findings, -Report
            report_wrong/1,             % +Report
            report_count/3,             % +Report, +Kind, -Count
            report_print/2              % +Reports, +Options
          ]).

/** <module> The report of a run

A report is report(Scenario, Figures, Findings), Figures being Name-Number
in the order of the table.

*Threading*: any thread.
*/

:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [max_list/2, member/2]).
:- use_module(library(solution_sequences), [limit/2]).
:- use_module(library(yall), [(>>)/4]).
:- use_module(library(option), [option/3]).
:- use_module(library(pairs), [group_pairs_by_key/2]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(verdict).

report_begin(Scenario, Seconds, Dir) :-
    format('~w, ~1f s, in ~w~n', [Scenario, Seconds, Dir]),
    flush_output.

%!  report(+Scenario, +Dir, +Events, +Evidence, +Findings, -Report) is det.
%
%   Also leaves the schedule, the findings and the kinds of messages in Dir.

report(Scenario, Dir, Events, Evidence, Findings,
       report(Scenario, Figures, Findings)) :-
    messages(Dir, Evidence.lives, Messages),
    findall(Name-Number,
            ( figure(Name, Events, Evidence, Number)
            ; Name = lines_printed,
              aggregate_all(sum(N), member(N-_, Messages), Number) ),
            Figures),
    write_terms(Dir, 'schedule.pl', Events),
    write_terms(Dir, 'findings.pl', Findings),
    write_terms(Dir, 'lives.pl', Evidence.lives),
    write_terms(Dir, 'messages.pl', Messages).

write_terms(Dir, Name, Terms) :-
    directory_file_path(Dir, Name, File),
    setup_call_cleanup(
        open(File, write, Out, [encoding(utf8)]),
        forall(member(Term, Terms), format(Out, '~q.~n', [Term])),
        close(Out)).

figure(seconds, _, Evidence, N) :-
    N = Evidence.seconds.
figure(agents, _, Evidence, N) :-
    length(Evidence.agents, N).
figure(hops, _, Evidence, N) :-
    count_events(at(_), Evidence, N).
figure(messages, _, Evidence, N) :-
    count_events(got(_, _), Evidence, N).
figure(clones, _, Evidence, N) :-
    count_events(born(_), Evidence, N).
figure(connections, _, Evidence, N) :-
    Evidence.proxies = counts(N, _, _).
figure(cuts, _, Evidence, N) :-
    Evidence.proxies = counts(_, N, _).
figure(stops, Events, _, N) :-
    aggregate_all(count, member(_-stop(_), Events), N).
figure(kills, _, Evidence, N) :-
    aggregate_all(count, ( member(life(_, _, _, To), Evidence.lives),
                           number(To) ), N).
figure(timer_kb, _, Evidence, N) :-
    (   Evidence.timers == []
    ->  N = 0
    ;   max_list(Evidence.timers, N)
    ).

count_events(Pattern, Evidence, Count) :-
    aggregate_all(count, member(e(_, _, Pattern, _, _), Evidence.events),
                  Count).

%!  report_wrong(+Report) is semidet.
%!  report_count(+Report, +Kind, -Count) is det.

report_wrong(report(_, _, Findings)) :-
    finding_kind(Kind, wrong, _),
    memberchk(finding(Kind, _), Findings),
    !.

report_count(report(_, _, Findings), Kind, Count) :-
    aggregate_all(count, member(finding(Kind, _), Findings), Count).

                /*******************************
                *           PRINTING           *
                *******************************/

%!  report_print(+Reports, +Options) is det.
%
%   The table, and the commands that repeat failures.

report_print(Reports, Options) :-
    line('', [Report,Text]>>( Report = report(Text, _, _) ), Reports),
    Reports = [report(_, Figures, _)|_],
    forall(member(Name-_, Figures),
           line(Name, [report(_, Fs, _),N]>>memberchk(Name-N, Fs), Reports)),
    forall(( finding_kind(Kind, Severity, Meaning),
             shown(Severity, Kind, Reports) ),
           ( format(atom(Head), '~w: ~w', [Severity, Meaning]),
             line(Head, [R,N]>>report_count(R, Kind, N), Reports) )),
    forall(member(Report, Reports), examples(Report)),
    (   member(Report, Reports),
        report_wrong(Report)
    ->  forall(( member(R, Reports), report_wrong(R) ), again(R, Options))
    ;   format('all is well~n')
    ).

shown(wrong, _, _) :-
    !.
shown(_, Kind, Reports) :-
    member(Report, Reports),
    report_count(Report, Kind, Count),
    Count > 0,
    !.

:- meta_predicate line(+, 2, +).

line(Head, Goal, Reports) :-
    format('~w~t~46|', [Head]),
    forall(member(Report, Reports),
           ( call(Goal, Report, Cell),
             format(atom(Column), '~t~w~9|', [Cell]),
             write(Column) )),
    nl.

%   The first few of each kind.

examples(report(Scenario, _, Findings)) :-
    forall(( finding_kind(Kind, wrong, _),
             limit(3, member(finding(Kind, What), Findings)) ),
           format('~w: ~w: ~p~n', [Scenario, Kind, What])).

again(report(Scenario, Figures, _), Options) :-
    option(seed(Seed), Options, 1),
    memberchk(seconds-Seconds, Figures),
    option(processes(Processes), Options, 4),
    option(agents(Agents), Options, 48),
    format('again: swipl test/chaos/run.pl -- --scenario ~w --seed ~w \c
            --seconds ~w --processes ~w --agents ~w~n',
           [Scenario, Seed, Seconds, Processes, Agents]).

                /*******************************
                *           MESSAGES           *
                *******************************/

%   messages(+Dir, +Lives, -Messages): Count-Kind of the lines that the
%   processes have printed, without numbers and names.

messages(Dir, Lives, Messages) :-
    findall(Kind,
            ( member(life(Name, Number, _, _), Lives),
              format(atom(File), '~w/~w.~d.messages', [Dir, Name, Number]),
              exists_file(File),
              read_file_to_string(File, Text, []),
              split_string(Text, "\n", "", Lines),
              member(Line, Lines),
              Line \== "",
              line_kind(Line, Kind) ),
            Kinds0),
    msort(Kinds0, Kinds),
    counted(Kinds, Pairs),
    findall(Count-Kind, member(Kind-Count, Pairs), Messages0),
    sort(1, @>=, Messages0, Messages).

counted(Kinds, Pairs) :-
    findall(Kind-x, member(Kind, Kinds), Xs),
    group_pairs_by_key(Xs, Groups),
    findall(Kind-N, ( member(Kind-L, Groups), length(L, N) ), Pairs).

line_kind(Line, Kind) :-
    split_string(Line, " ", " ", Words),
    findall(Word, ( member(W, Words), word_kind(W, Word) ), Kinds),
    atomic_list_concat(Kinds, ' ', Kind).

word_kind(Word, '_') :-
    sub_string(Word, _, _, _, "@"),
    !.
word_kind(Word, Kind) :-
    string_codes(Word, Codes0),
    findall(C, ( member(C0, Codes0), digit_out(C0, C) ), Codes1),
    squeeze(Codes1, Codes),
    atom_codes(Kind, Codes).

digit_out(C0, 0'#) :-
    code_type(C0, digit),
    !.
digit_out(C, C).

squeeze([0'#,0'#|Cs], Ds) :-
    !,
    squeeze([0'#|Cs], Ds).
squeeze([C|Cs], [C|Ds]) :-
    !,
    squeeze(Cs, Ds).
squeeze([], []).
