:- module(typhon_page_models,
          [ models_start/1,             % +Options
            models_stop/0,
            model_shown/0,
            model_dict/2,               % +Message, -Dict
            model_set_up/1,             % +Message
            parameter_dict/2            % +Parameter, -Dict
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [foldl/4, maplist/3, partition/4]).
:- use_module(library(error), [existence_error/2, must_be/2]).
:- use_module(library(lists), [member/2]).
:- use_module(library(option), [option/2]).
:- use_module('../../kernel/base/error_lines', [error_text/2]).
:- use_module('../../kernel/base/monotonic', [monotonic_time/1]).
:- use_module('../../kernel/base/own_thread', [in_own_thread/1]).
:- use_module('../../kernel/host', [time_kind/1, time_now/1]).
:- use_module(editor, [read_text/3]).
:- use_module(protocol, [name_text/2, number_json/2, text/2]).
:- use_module(runs, [run_begin/2, run_control/2, run_end/1, runs_rest/0]).

/** <module> A program with parameters, which browsers set up and run

The page has a view of a model with the option model(Goal).  The page calls
call(Goal, Request), with these requests:

  - about(-Title, -Parameters)
    Parameters are parameter(Name, Value, Range): Value is the one at first,
    Range is range(From, To, Step); a list of values, one of which may be a
    range; or anything else, for a field without a slider
  - set_up(+Pairs)
    start a network; Pairs are Name-Value, with all parameters
  - run
    run it, to its end
  - measures(-Pairs)
    Label-Number, as of now
  - end
    stop the network, if there is one

Numbers that `measures` gives while the model runs are samples, one for each
time at which a browser asks, but for times at which nothing can have changed.

*Threading*: a mutex serialises requests, but for `run`, which runs beside the
page, see run_begin/2.
*/

:- dynamic
    model/1,                    % Goal of the page that is served
    run_of/3,                   % Number, Run, Start
    ended/2,                    % Number, Text: "" if the run succeeded
    value/2,                    % Name, Value: of the latest set-up
    sample/3.                   % Number, Time, Pairs

%!  models_start(+Options) is det.
%!  models_stop is det.
%!  model_shown is semidet.
%
%   Set the model from the option model(Goal); end it, and its run; succeed if
%   the page has one.

models_start(Options) :-
    (   option(model(Goal), Options)
    ->  must_be(callable, Goal),
        assertz(model(Goal))
    ;   true
    ).

models_stop :-
    (   retract(model(Goal))
    ->  in_own_thread(with_mutex(typhon_page_models, end_run(Goal)))
    ;   true
    ).

model_shown :-
    model(_).

the_model(Goal) :-
    model(Goal),
    !.
the_model(_) :-
    existence_error(page_view, model).

                /*******************************
                *             RUNS             *
                *******************************/

%!  model_set_up(+Message:dict) is det.
%
%   End the run, if there is one, and set the model up with the field `values` of
%   Message, which has the text of a value for names of parameters.  Other
%   parameters have their first values.  Virtual time is paused then.
%
%   @error existence_error(page_view, model), page_syntax(Field, Error, Where)

model_set_up(Message) :-
    the_model(Goal),
    ( get_dict(values, Message, Texts) -> must_be(dict, Texts) ; Texts = _{} ),
    call(Goal, about(_, Parameters)),
    maplist(chosen(Texts), Parameters, Pairs),
    with_mutex(typhon_page_models, set_up(Goal, Pairs)).

chosen(Texts, parameter(Name, First, _), Name-Value) :-
    (   get_dict(Name, Texts, Text)
    ->  must_be(string, Text),
        read_text(Name, Text, Value)
    ;   Value = First
    ).

set_up(Goal, Pairs) :-
    end_run(Goal),
    forall(member(Name-Value, Pairs), assertz(value(Name, Value))),
    catch(must(Goal, set_up(Pairs)), Ball, ( call(Goal, end), throw(Ball) )),
    (   time_kind(virtual)
    ->  run_control(pause, _{})
    ;   true
    ),
    flag(typhon_page_runs, Number, Number+1),
    monotonic_time(Start),
    run_begin(run(Number, Goal), Run),
    assertz(run_of(Number, Run, Start)).

must(Goal, Request) :-
    (   call(Goal, Request)
    ->  true
    ;   functor(Request, Name, _),
        throw(error(page_failed(Name), _))
    ).

:- public run/2.

run(Number, Goal) :-
    catch(( must(Goal, run), Text = "" ),
          error(Formal, Context), error_text(error(Formal, Context), Text)),
    assertz(ended(Number, Text)),
    (   time_kind(virtual)
    ->  run_control(pause, _{})
    ;   true
    ).

end_run(Goal) :-
    runs_rest,
    (   retract(run_of(_, Run, _))
    ->  run_end(Run),
        call(Goal, end)
    ;   true
    ),
    retractall(ended(_, _)),
    retractall(value(_, _)),
    retractall(sample(_, _, _)).

                /*******************************
                *       WHAT BROWSERS SEE      *
                *******************************/

%!  model_dict(+Message:dict, -Dict) is det.
%
%   Dict is _{title, parameters, run, state, error, samples, count}.  Samples are
%   those of the present run after the first `since` ones, if Message has the
%   number of that run in its field `run`; else all.
%
%   @error existence_error(page_view, model)

model_dict(Message, Dict) :-
    the_model(Goal),
    call(Goal, about(Title, Parameters)),
    maplist(parameter_shown, Parameters, Dicts),
    name_text(Title, TitleText),
    with_mutex(typhon_page_models, run_seen(Goal, Message, Run)),
    Dict = Run.put(_{title:TitleText, parameters:Dicts}).

parameter_shown(parameter(Name, First, Range), Dict) :-
    ( value(Name, Value) -> true ; Value = First ),
    parameter_dict(parameter(Name, Value, Range), Dict).

%!  parameter_dict(+Parameter, -Dict) is det.
%
%   Parameter is parameter(Name, Value, Range).  Dict is _{name, value}, with
%   _{from, to, step} of a range, and _{values} of a list: texts, but for numbers
%   of a range.

parameter_dict(parameter(Name, Value, Range), Dict) :-
    maplist(text, [Name, Value], [NameText, ValueText]),
    range_dict(Range, Dict0),
    Dict = Dict0.put(_{name:NameText, value:ValueText}).

range_dict(range(From, To, Step), Dict) =>
    Dict = _{from:From, to:To, step:Step}.
range_dict(Choices, Dict), is_list(Choices) =>
    partition(is_range, Choices, Ranges, Values),
    maplist(text, Values, Texts),
    foldl(range_added, Ranges, _{values:Texts}, Dict).
range_dict(_, Dict) =>
    Dict = _{}.

is_range(range(_, _, _)).

range_added(Range, Dict0, Dict) :-
    range_dict(Range, Dict1),
    Dict = Dict0.put(Dict1).

run_seen(Goal, Message, Dict) :-
    run_of(Number, _, Start),
    !,
    run_state(Number, State, Error),
    look(Goal, Start),
    (   get_dict(run, Message, Number),
        get_dict(since, Message, Since)
    ->  true
    ;   Since = 0
    ),
    findall([Time, Rows], ( sample(N, Time, Rows), N > Since ), Samples),
    aggregate_all(count, sample(_, _, _), Count),
    Dict = _{run:Number, state:State, error:Error, samples:Samples, count:Count}.
run_seen(_, _, _{run:null, state:none, error:"", samples:[], count:0}).

run_state(Number, State, Error) :-
    (   ended(Number, Error)
    ->  ( Error == "" -> State = finished ; State = failed )
    ;   State = running,
        Error = ""
    ).

%   Add a sample, unless no time has passed since the last one.

look(Goal, Start) :-
    aggregate_all(count, sample(_, _, _), Count),
    time_of_run(Start, Time),
    (   sample(Count, Time, _)
    ->  true
    ;   call(Goal, measures(Pairs))
    ->  findall([Text, Json], ( member(Label-Number, Pairs),
                                name_text(Label, Text),
                                number_json(Number, Json) ), Rows),
        Next is Count+1,
        assertz(sample(Next, Time, Rows))
    ;   true
    ).

time_of_run(Start, Time) :-
    (   time_kind(virtual)
    ->  time_now(Time)
    ;   monotonic_time(Now),
        Time is Now-Start
    ).
