------- The small turbine in the files of FAST 8 ------------------------------
Names and layout as FAST's, values invented
---------------------- SIMULATION CONTROL --------------------------------------
       3.01   TMax            - Total run time (s)
---------------------- FEATURE SWITCHES AND FLAGS ------------------------------
          1   CompElast       - {1=ElastoDyn; 2=ElastoDyn + BeamDyn for blades}
          1   CompInflow      - {0=still air; 1=InflowWind}
          1   CompAero        - {0=None; 1=AeroDyn v14; 2=AeroDyn v15}
          1   CompServo       - {0=None; 1=ServoDyn}
          0   CompHydro       - {0=None; 1=HydroDyn}
---------------------- INPUT FILES ---------------------------------------------
"elasto.dat"            EDFile       - ElastoDyn
"unused"                BDBldFile(1) - BeamDyn
"../parts/wind.dat"     InflowFile   - wind
"aero.ipt"              AeroFile     - AeroDyn
"../parts/servo.dat"    ServoFile    - ServoDyn
