%% Erlang's hops for bench/peers.pl: two nodes, and what goes to and fro.
%%
%%   erl -noshell ... -run hop main There Ebin hops
%%
%% An agent is a fun of 30 clauses and a list of 10 facts. Its source goes
%% with it: the fun was made by erl_eval, so it travels as abstract forms,
%% and is evaluated wherever it is. A host makes a process for each agent
%% that comes. A known fun is one that both hosts were given before, as ours
%% have the program of an agent from its first visit on: only its hash goes
%% with the facts. Nothing is answered, counted or kept for the case that it
%% gets lost.
%%
%% Epmd is not needed: both nodes listen on one port, of two addresses.

-module(hop).
-export([main/1, start/2, measured/3, tell/2]).

main([There, Ebin, "hops"]) ->
    {ok, Peer, Node} = start(There, Ebin),
    register(host, spawn_link(fun() -> host(#{}) end)),
    erpc:call(Node, erlang, apply, [fun started/0, []]),
    agents(Node),
    peer:stop(Peer),
    halt().

start(There, Ebin) ->
    [Name, Address] = string:split(There, "@"),
    peer:start_link(#{name => Name, host => Address,
                      connection => standard_io,
                      args => ["+sbwt", "none", "-pa", Ebin, "-setcookie",
                               atom_to_list(erlang:get_cookie()),
                               "-start_epmd", "false",
                               "-erl_epmd_port", port(),
                               "-kernel", "inet_dist_use_interface",
                               interface(Address)]}).

port() ->
    {ok, [[Port]]} = init:get_argument(erl_epmd_port),
    Port.

interface(Address) ->
    {ok, Numbers} = inet:parse_address(Address),
    lists:flatten(io_lib:format("~w", [Numbers])).

started() ->
    register(host, spawn(fun() -> host(#{}) end)).

%% What takes agents in.

host(Known) ->
    receive
        {arrive, Agent, Facts} when is_function(Agent) ->
            spawn(fun() -> Agent({arrived, Facts}) end),
            host(Known);
        {arrive, Hash, Facts} ->
            #{Hash := Agent} = Known,
            spawn(fun() -> Agent({arrived, Facts}) end),
            host(Known);
        {know, Hash, Agent} ->
            host(Known#{Hash => Agent})
    end.

%%                          ---- agents ----

agents(Node) ->
    Agent = evaluated(program()),
    Hash = erlang:md5(program()),
    [{host, On} ! {know, Hash, Agent} || On <- [node(), Node]],
    agents("hops", Hash, Hash, Node),
    agents("hops_with_program", Agent, whole, Node).

agents(What, Agent, Program, Node) ->
    Run = fun(Many, Hops) ->
              travel(Agent, facts(Hops div Many, Program, Node), Many)
          end,
    Run(1, 4000),                       % warm up
    measured(What ++ "(one)", 20000, fun() -> Run(1, 20000) end),
    measured(What ++ "(ten)", 40000, fun() -> Run(10, 40000) end).

travel(Agent, Facts, Many) ->
    [host ! {arrive, Agent, Facts} || _ <- lists:seq(1, Many)],
    [receive done -> ok end || _ <- lists:seq(1, Many)].

facts(Left, Program, Node) ->
    [{left, Left}, {program, Program}, {there, Node}, {here, node()},
     {home, self()} | [{I, {value, I}} || I <- lists:seq(1, 5)]].

%% The source of the agent.

program() ->
    Rules = [io_lib:format("Agent({rule, ~w, X}) -> Y = X + ~w, "
                           "case Y > 0 of true -> Agent({other, Y}) end;~n",
                           [I, I])
             || I <- lists:seq(1, 27)],
    lists:flatten(
      ["fun Agent({arrived, Facts}) ->
            {value, {left, N}, Rest} = lists:keytake(left, 1, Facts),
            Agent({left, N, Rest});
        Agent({left, 0, Facts}) ->
            {home, Home} = lists:keyfind(home, 1, Facts),
            Home ! done;
        ", Rules, "
        Agent({left, N, Facts}) ->
            {there, There} = lists:keyfind(there, 1, Facts),
            {here, Here} = lists:keyfind(here, 1, Facts),
            To = case node() of Here -> There; _ -> Here end,
            Program = case lists:keyfind(program, 1, Facts) of
                {program, whole} -> Agent;
                {program, Hash} -> Hash
            end,
            {host, To} ! {arrive, Program, [{left, N - 1} | Facts]}
        end."]).

evaluated(Source) ->
    {ok, Tokens, _} = erl_scan:string(Source),
    {ok, [Form]} = erl_parse:parse_exprs(Tokens),
    {value, Fun, _} = erl_eval:expr(Form, erl_eval:new_bindings()),
    Fun.

%%                          ---- figures ----

measured(What, Count, Run) ->
    tell("begin", []),
    Run(),
    tell("done(~s, ~w)", [What, Count]).

tell(Format, Args) ->
    io:format(Format ++ ".~n", Args),
    io:get_line("").
